#pragma once

#include <unistd.h>

#include <string>

namespace barchan {

/// Of this machine; empty where it has none.
[[nodiscard]] inline std::string host_name() {
  char name[256] = {};
  (void)::gethostname(name, sizeof name - 1);
  return name;
}

}  // namespace barchan

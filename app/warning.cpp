#include <barchan/app/warning.hpp>

#include <cstdio>

namespace barchan::app {

void print_warning(const std::string& text) {
  std::fprintf(stderr, "barchan: warning: %s\n", text.c_str());
}

}  // namespace barchan::app

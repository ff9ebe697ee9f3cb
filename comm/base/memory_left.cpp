#include <barchan/comm/base/memory_left.hpp>

#include <fstream>
#include <limits>
#include <string>

namespace barchan {

double memory_left() {
  std::ifstream file("/proc/meminfo");
  std::string name, unit;
  double kibibytes = 0.0;
  while (file >> name >> kibibytes) {
    if (name == "MemAvailable:") return 1024.0 * kibibytes;
    std::getline(file, unit);
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace barchan

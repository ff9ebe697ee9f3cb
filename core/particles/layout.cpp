#include <barchan/core/particles/layout.hpp>

#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace barchan {
namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;

}  // namespace

void* allocate_lines(std::size_t bytes) {
  const bool is_huge = bytes >= 2 * kHugePage;
  const std::size_t alignment = is_huge ? kHugePage : 64;
  void* p = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (p == nullptr) throw std::bad_alloc();
#ifdef __linux__
  // Whole pages alone, so that no more becomes resident. A system without them says no: fine.
  if (is_huge) static_cast<void>(madvise(p, bytes / kHugePage * kHugePage, MADV_HUGEPAGE));
#endif
  return p;
}

}  // namespace barchan

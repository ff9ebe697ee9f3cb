#pragma once

// Orders that ThreadSanitizer cannot see, since oneTBB's library is built without it: what hands
// work on says release, what takes it up says acquire, with the address of the node between them.
// Nothing in other builds.

#if defined(__SANITIZE_THREAD__)
#define BARCHAN_WITH_TSAN 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define BARCHAN_WITH_TSAN 1
#endif
#endif

#ifdef BARCHAN_WITH_TSAN
#include <sanitizer/tsan_interface.h>
#endif

namespace barchan {

#ifdef BARCHAN_WITH_TSAN
inline constexpr bool kTellsOrder = true;
#else
inline constexpr bool kTellsOrder = false;
#endif

/// All that this thread has done precedes all that follows an acquire of the same edge.
inline void tell_release([[maybe_unused]] const void* edge) {
#ifdef BARCHAN_WITH_TSAN
  __tsan_release(const_cast<void*>(edge));
#endif
}

inline void tell_acquire([[maybe_unused]] const void* edge) {
#ifdef BARCHAN_WITH_TSAN
  __tsan_acquire(const_cast<void*>(edge));
#endif
}

}  // namespace barchan

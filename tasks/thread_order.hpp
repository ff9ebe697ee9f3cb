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

/// What was done before is seen by the node's task.
template <typename Node, typename Message>
void put(Node& node, const Message& message) {
  tell_release(&node);
  node.try_put(message);
}

/// As long as a task of a graph runs: after what was put into its node, before what waits for the
/// graph.
class TaskOrder {
 public:
  TaskOrder(const void* node, const void* graph) : graph_(graph) { tell_acquire(node); }
  ~TaskOrder() { tell_release(graph_); }
  TaskOrder(const TaskOrder&) = delete;
  TaskOrder& operator=(const TaskOrder&) = delete;

 private:
  const void* graph_;
};

}  // namespace barchan

#pragma once

#include <functional>
#include <memory>

#include <barchan/tasks/step_tasks.hpp>

namespace barchan {

/// A list of tasks as a graph of oneTBB, built once: tasks are nodes that count their predecessors,
/// edges are edges. Every task has two nodes, for even and odd steps, since a task may be told of
/// the next step while it is still to do this one: parity 0 or 1. An edge into the next step leads
/// to the other parity. What it carries stays there until that step is run; as if a step before had
/// been done, the first one finds it there.
class TaskGraph {
 public:
  using Body = std::function<void(const StepTask& task, int parity)>;

  TaskGraph(StepTasks list, int num_threads, Body body);
  ~TaskGraph();
  TaskGraph(const TaskGraph&) = delete;
  TaskGraph& operator=(const TaskGraph&) = delete;

  /// On the graph's threads: `begin`, then all tasks that become ready, until none is left.
  /// Throws what a task threw; the graph then serves no more.
  void run(const std::function<void()>& begin);
  /// A message, to one of the list's messages or in the place of one. By `begin` or a task.
  /// @param task  index in the list
  void put(int task, int parity);
  /// Runs a function for 0 … num − 1 on the graph's threads. Not within run().
  void for_each(int num, const std::function<void(int)>& body);

  [[nodiscard]] const StepTasks& list() const { return list_; }

 private:
  struct Nodes;
  class Order;
  void build();
  void do_task(int task, int parity);
  void tell_successors(int task, int parity) const;

  StepTasks list_;
  Body body_;
  std::unique_ptr<Nodes> nodes_;
};

}  // namespace barchan

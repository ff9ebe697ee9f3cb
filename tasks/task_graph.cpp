#include <barchan/tasks/task_graph.hpp>

#include <array>
#include <utility>
#include <vector>

#include <tbb/flow_graph.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <barchan/tasks/thread_order.hpp>

namespace barchan {
namespace {

using Signal = tbb::flow::continue_msg;

/// The edge from who runs the graph to all of its tasks, which look for their own edges behind it.
const char kBeginOfRun = 0;

bool is_message(Work work) {
  return work == Work::Begin || work == Work::Arrived;
}

/// A function for every lane. Nothing is read before the thread has taken it up.
struct LaneTasks {
  const std::function<void(int)>& body;
  char end = 0;  ///< its address is the edge to who waits for all lanes

  void operator()(int l) const {
    tell_acquire(this);
    body(l);
    tell_release(&end);
  }
};

}  // namespace

struct TaskGraph::Nodes {
  struct Node {
    std::unique_ptr<tbb::flow::graph_node> owner;  ///< null: End
    tbb::flow::receiver<Signal>* in = nullptr;
    tbb::flow::sender<Signal>* out = nullptr;
  };

  explicit Nodes(int num_threads)
      : workers(tbb::global_control::max_allowed_parallelism,
                static_cast<std::size_t>(num_threads)),
        arena(num_threads) {}

  template <class Made>
  void add(int parity, std::unique_ptr<Made> node) {
    Node entry;
    entry.in = node.get();
    entry.out = node.get();
    entry.owner = std::move(node);
    of[static_cast<std::size_t>(parity)].push_back(std::move(entry));
  }
  [[nodiscard]] const Node& at(int task, int parity) const {
    return of[static_cast<std::size_t>(parity)][static_cast<std::size_t>(task)];
  }

  tbb::global_control workers;  ///< the requested number, also on a node with fewer cores
  tbb::task_arena arena;
  std::unique_ptr<tbb::flow::graph> graph;
  std::array<std::vector<Node>, 2> of;  ///< by parity and task
};

/// As long as a task runs: after what precedes it, before what it precedes and who waits for all.
class TaskGraph::Order {
 public:
  Order(const TaskGraph& graph, int task, int parity)
      : graph_(graph), task_(task), parity_(parity) {
    tell_acquire(&graph_.nodes_->at(task, parity));
  }
  ~Order() {
    graph_.tell_successors(task_, parity_);
    tell_release(graph_.nodes_.get());
  }
  Order(const Order&) = delete;
  Order& operator=(const Order&) = delete;

 private:
  const TaskGraph& graph_;
  int task_, parity_;
};

TaskGraph::TaskGraph(StepTasks list, int num_threads, Body body)
    : list_(std::move(list)), body_(std::move(body)), nodes_(std::make_unique<Nodes>(num_threads)) {
  nodes_->arena.execute([this] { build(); });
}

TaskGraph::~TaskGraph() = default;

void TaskGraph::build() {
  nodes_->graph = std::make_unique<tbb::flow::graph>();
  const int num_tasks = static_cast<int>(list_.tasks.size());
  for (const int parity : {0, 1}) {
    for (int t = 0; t < num_tasks; ++t) {
      const Work work = list_.tasks[static_cast<std::size_t>(t)].work;
      if (work == Work::End)
        nodes_->of[static_cast<std::size_t>(parity)].emplace_back();
      else if (is_message(work))
        nodes_->add(parity, std::make_unique<tbb::flow::broadcast_node<Signal>>(*nodes_->graph));
      else
        nodes_->add(parity, std::make_unique<tbb::flow::continue_node<Signal>>(
                                *nodes_->graph, [this, t, parity](const Signal&) {
                                  tell_acquire(&kBeginOfRun);
                                  do_task(t, parity);
                                }));
    }
  }
  const auto each_edge = [this](const auto& visit) {
    for (const StepArrow& a : list_.arrows) {
      if (a.way == Way::Edge && nodes_->at(a.to, 0).in != nullptr) visit(a);
    }
  };
  each_edge([this](const StepArrow& a) {
    for (const int parity : {0, 1})
      tbb::flow::make_edge(*nodes_->at(a.from, parity).out,
                           *nodes_->at(a.to, a.parity_of_to(parity)).in);
  });
  each_edge([this](const StepArrow& a) {
    if (a.is_next) put(a.to, 0);
  });
}

void TaskGraph::do_task(int task, int parity) {
  const Order order(*this, task, parity);
  body_(list_.tasks[static_cast<std::size_t>(task)], parity);
}

void TaskGraph::tell_successors([[maybe_unused]] int task, [[maybe_unused]] int parity) const {
  if constexpr (kTellsOrder) {
    for (const StepArrow& a : list_.arrows) {
      if (a.from == task && a.way == Way::Edge)
        tell_release(&nodes_->at(a.to, a.parity_of_to(parity)));
    }
  }
}

void TaskGraph::put(int task, int parity) {
  const Nodes::Node& node = nodes_->at(task, parity);
  tell_release(&node);
  if (is_message(list_.tasks[static_cast<std::size_t>(task)].work)) tell_successors(task, parity);
  node.in->try_put(Signal());
}

void TaskGraph::run(const std::function<void()>& begin) {
  nodes_->arena.execute([&] {
    tell_release(&kBeginOfRun);
    begin();
    nodes_->graph->wait_for_all();
    tell_acquire(nodes_.get());
  });
}

void TaskGraph::for_each(int num, const std::function<void(int)>& body) {
  nodes_->arena.execute([&] {
    const LaneTasks tasks{body};
    tell_release(&tasks);
    tbb::parallel_for(0, num, tasks, tbb::simple_partitioner());
    tell_acquire(&tasks.end);
  });
}

}  // namespace barchan

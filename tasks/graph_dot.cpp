#include <barchan/tasks/graph_dot.hpp>

#include <fmt/format.h>

namespace barchan {
namespace {

Side side_of(Work work) {
  return work == Work::LeftBand ? Side::Left : Side::Right;
}

bool is_band(Work work) {
  return work == Work::LeftBand || work == Work::RightBand;
}

std::string arrival_id(int rank, int link) {
  return fmt::format("r{}_arrived{}", rank, link);
}

std::string id_of(const StepTask& task, int rank) {
  switch (task.work) {
    case Work::Begin:
      return fmt::format("r{}_begin", rank);
    case Work::Chunks:
      return fmt::format("r{}_chunks{}", rank, task.lane);
    case Work::Await:
      return fmt::format("r{}_await", rank);
    case Work::AwaitRight:
      return fmt::format("r{}_await_right", rank);
    case Work::End:
      return fmt::format("r{}_end", rank);
    case Work::LeftBand:
    case Work::RightBand:
      return fmt::format("r{}_{}{}", rank, name_of(side_of(task.work)), task.lane);
    default:
      return arrival_id(rank, task.lane);
  }
}

/// At the other end of a link.
int rank_of(const GraphShape& shape, int link) {
  for (const auto& lane : shape.lanes) {
    for (const LaneTie& tie : lane.ties) {
      if (tie.link == link) return tie.rank;
    }
  }
  return -1;
}

std::string label_of(const StepTask& task, const GraphShape& shape) {
  const Side side = side_of(task.work);
  switch (task.work) {
    case Work::Begin:
      return "begin of step k";
    case Work::End:
      return "end of step k";
    case Work::Await:
      return "await halos\\npolls until they are in";
    case Work::AwaitRight:
      return "await the right halos\\npolls until they are in";
    case Work::Chunks: {
      const int n = shape.lanes[static_cast<std::size_t>(task.lane)].num_chunks;
      return fmt::format("lane {}: {} chunk{}\\none after the other, polls after each", task.lane,
                         n, n == 1 ? "" : "s");
    }
    case Work::LeftBand:
    case Work::RightBand:
      return fmt::format("{} band of lane {}\\npairs, rows{}", name_of(side), task.lane,
                         shape.is_remote(task.lane, side) ? ", pack, send" : ", post");
    default:
      return fmt::format("halo from rank {} is in", rank_of(shape, task.lane));
  }
}

const char* colour_of(Work work) {
  if (work == Work::Begin || work == Work::End) return "#eeeeee";
  if (work == Work::Chunks) return "#cfe3f7";
  return is_band(work) ? "#d8efd3" : "#fbe2c4";
}

std::string style_of(const StepArrow& arrow) {
  if (arrow.way == Way::Message)
    return fmt::format(" [style=dotted, label=\"{}\"{}]", arrow.note,
                       arrow.is_next ? ", constraint=false" : "");
  return arrow.is_next ? " [color=\"#888888\", constraint=false, label=\"next step\"]" : "";
}

/// What a band waits for is what the lane beyond the cut sends in the step before.
std::string messages(const GraphShape& shape, int rank) {
  std::string text;
  for (int l = 0; l < shape.num_lanes(); ++l) {
    for (const LaneTie& tie : shape.ties(l)) {
      if (tie.link < 0) continue;
      const bool is_left = shape.sending_band(tie) == Side::Left;
      const StepTask sender{is_left ? Work::LeftBand : Work::RightBand, l};
      text += fmt::format(
          "  {} -> {} [style=dashed, color=\"#c05a00\", constraint=false, label=\"next step\"];\n",
          id_of(sender, rank), arrival_id(tie.rank, tie.peer));
    }
  }
  return text;
}

}  // namespace

std::string cluster_of(const GraphShape& shape, int rank) {
  const StepTasks list = step_tasks(shape);
  std::string text = fmt::format("  subgraph cluster_rank{0} {{\n    label=\"rank {0}\";\n", rank);
  for (const StepTask& task : list.tasks)
    text += fmt::format("    {} [label=\"{}\", fillcolor=\"{}\"];\n", id_of(task, rank),
                        label_of(task, shape), colour_of(task.work));
  const auto id = [&](int task) { return id_of(list.tasks[static_cast<std::size_t>(task)], rank); };
  for (const StepArrow& arrow : list.arrows)
    text += fmt::format("    {} -> {}{};\n", id(arrow.from), id(arrow.to), style_of(arrow));
  return text + "  }\n";
}

std::string graph_dot(const Communicator& communicator, const GraphShape& shape) {
  const int rank = communicator.rank();
  const auto clusters = communicator.gather(cluster_of(shape, rank));
  const auto between = communicator.gather(messages(shape, rank));
  if (!communicator.is_root()) return {};
  std::string text =
      "// One time step: boxes are tasks, solid edges are \"precedes\", dotted ones messages into "
      "the graph,\n// dashed ones messages between ranks.\n// dot -Tsvg FILE > graph.svg\ndigraph "
      "step {\n  node [shape=box, style=filled, fontname=\"sans-serif\"];\n";
  for (const auto& part : clusters) text += part;
  for (const auto& part : between) text += part;
  return text + "}\n";
}

}  // namespace barchan

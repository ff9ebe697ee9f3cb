#include <barchan/tasks/graph_dot.hpp>

#include <fmt/format.h>

namespace barchan {
namespace {

std::string id(int rank, const char* what, int lane) {
  return fmt::format("r{}_{}{}", rank, what, lane);
}

std::string node(const std::string& name, const std::string& label, const char* colour) {
  return fmt::format("    {} [label=\"{}\", fillcolor=\"{}\"];\n", name, label, colour);
}

std::string edge(const std::string& from, const std::string& to, const char* how = "") {
  return fmt::format("    {} -> {}{};\n", from, to, how);
}

constexpr const char* kWork = "#cfe3f7";
constexpr const char* kBand = "#d8efd3";
constexpr const char* kMessage = "#fbe2c4";
constexpr const char* kPlain = "#eeeeee";

std::string lane_nodes(const GraphShape::LaneShape& lane, int rank, int l) {
  const char* plural = lane.num_chunks == 1 ? "" : "s";
  std::string text = node(id(rank, "chunks", l),
                          fmt::format("lane {}: {} chunk{}\\none after the other, polls after each",
                                      l, lane.num_chunks, plural),
                          kWork);
  const auto band = [&](bool is_outer, const char* side) {
    return fmt::format("{} band of lane {}\\npairs, rows{}", side, l,
                       is_outer ? ", pack, send" : ", post");
  };
  if (lane.has_left) text += node(id(rank, "left", l), band(lane.is_outer_left, "left"), kBand);
  if (lane.has_right) text += node(id(rank, "right", l), band(lane.is_outer_right, "right"), kBand);
  return text;
}

std::string lane_edges(const GraphShape::LaneShape& lane, int rank, int l) {
  const std::string begin = fmt::format("r{}_begin", rank), end = fmt::format("r{}_end", rank);
  std::string last = id(rank, "chunks", l);
  std::string text = edge(begin, last);
  const auto follow = [&](bool exists, const char* what) {
    if (!exists) return;
    text += edge(last, id(rank, what, l));
    last = id(rank, what, l);
  };
  follow(lane.has_left, "left");
  follow(lane.has_right, "right");
  return text + edge(last, end);
}

/// The arrivals at the ends of the strip: noticed by polls of the chunks, or in the end by drain.
std::string arrivals(const GraphShape& shape, int rank) {
  std::string text;
  const int last = static_cast<int>(shape.lanes.size()) - 1;
  for (const Side side : {Side::Left, Side::Right}) {
    if (!shape.neighbours.has(side)) continue;
    const bool is_left = side == Side::Left;
    const std::string arrived = fmt::format("r{}_arrived_{}", rank, name_of(side));
    text += node(arrived, fmt::format("halo from rank {} is in", shape.neighbours.rank(side)),
                 kMessage);
    text += edge(arrived, id(rank, is_left ? "left" : "right", is_left ? 0 : last));
    if (shape.is_sequential) {
      text += edge(arrived, fmt::format("r{}_begin", rank), " [label=\"waited for\"]");
      continue;
    }
    for (int l = 0; l <= last; ++l) {
      text += edge(id(rank, "chunks", l), arrived, " [style=dotted, label=\"poll\"]");
    }
  }
  return text;
}

std::string messages(const GraphShape& shape, int rank) {
  std::string text;
  const int last = static_cast<int>(shape.lanes.size()) - 1;
  for (const Side side : {Side::Left, Side::Right}) {
    if (!shape.neighbours.has(side)) continue;
    const bool is_left = side == Side::Left;
    text += fmt::format(
        "  {} -> r{}_arrived_{} [style=dashed, color=\"#c05a00\", constraint=false, "
        "label=\"next step\"];\n",
        id(rank, is_left ? "left" : "right", is_left ? 0 : last), shape.neighbours.rank(side),
        name_of(opposite(side)));
  }
  return text;
}

}  // namespace

std::string cluster_of(const GraphShape& shape, int rank) {
  std::string text = fmt::format("  subgraph cluster_rank{0} {{\n    label=\"rank {0}\";\n", rank);
  text += node(fmt::format("r{}_begin", rank), "begin of step k", kPlain);
  text += node(fmt::format("r{}_end", rank), "end of step k", kPlain);
  for (std::size_t l = 0; l < shape.lanes.size(); ++l) {
    text += lane_nodes(shape.lanes[l], rank, static_cast<int>(l));
    text += lane_edges(shape.lanes[l], rank, static_cast<int>(l));
  }
  return text + arrivals(shape, rank) + "  }\n";
}

std::string graph_dot(const Communicator& communicator, const GraphShape& shape) {
  const int rank = communicator.rank();
  const auto clusters = communicator.gather(cluster_of(shape, rank));
  const auto between = communicator.gather(messages(shape, rank));
  if (!communicator.is_root()) return {};
  std::string text =
      "// One time step: boxes are tasks, solid edges are \"precedes\", dotted ones polls, dashed "
      "ones messages.\n// dot -Tsvg FILE > graph.svg\ndigraph step {\n"
      "  node [shape=box, style=filled, fontname=\"sans-serif\"];\n";
  for (const auto& part : clusters) text += part;
  for (const auto& part : between) text += part;
  return text + "}\n";
}

}  // namespace barchan

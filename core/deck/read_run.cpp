// The run itself: domain, time, stages, search, output, checkpoints.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <barchan/core/base/nearest.hpp>
#include <barchan/core/deck/boxes.hpp>
#include <barchan/core/deck/readers.hpp>
#include <barchan/core/deck/values.hpp>

namespace barchan::deck {

namespace {

constexpr std::string_view kAxisNames[] = {"x", "y", "z"};

int axis_index(const std::string& name, int dimension, const SourcePlace& place) {
  const auto axes = std::span(kAxisNames).first(static_cast<std::size_t>(dimension));
  for (int axis = 0; axis < dimension; ++axis) {
    if (name == axes[axis]) return axis;
  }
  throw InputError(place, fmt::format("'{}' is not an axis in {} dimensions", name, dimension),
                   dimension == 2 ? "axes are x and y" : "axes are x, y and z");
}

int longest_axis(const Domain& domain, int dimension) {
  int longest = 0;
  for (int axis = 1; axis < dimension; ++axis) {
    if (domain.hi[axis] - domain.lo[axis] > domain.hi[longest] - domain.lo[longest]) longest = axis;
  }
  return longest;
}

void read_outside(const TableReader& table, bool has_periodic, Domain& domain) {
  const std::string outside = table.string("outside");
  if (outside == "delete") domain.outside = OutsidePolicy::Delete;
  if (outside != "periodic") return;
  if (has_periodic) {
    table.fail("outside", "[domain] has both periodic and outside = \"periodic\"",
               "keep outside for all axes, or name the axes in periodic and say error or delete "
               "for the others");
  }
  for (int axis = 0; axis < table.dimension(); ++axis)
    domain.periodic[static_cast<std::size_t>(axis)] = true;
}

CutWish read_cuts(const TableReader& table) {
  CutWish wish;
  const Node* value = table.value("cuts");
  if (value == nullptr) return wish;
  wish.place = value->place();
  if (value->kind == Node::Kind::String && value->text == "auto") return wish;
  wish.kind = CutWish::Kind::Strips;
  if (value->kind == Node::Kind::String && value->text == "strips") return wish;
  wish.kind = CutWish::Kind::Bricks;
  const auto num_axes = static_cast<std::size_t>(table.dimension());
  const std::string remedy =
      fmt::format("write \"auto\", \"strips\" or {}", num_axes == 2 ? "[2, 2]" : "[2, 2, 1]");
  if (value->kind != Node::Kind::Array || value->items.size() != num_axes)
    table.fail("cuts", fmt::format("cuts: expected a word or {} integers", num_axes), remedy);
  for (std::size_t axis = 0; axis < num_axes; ++axis) {
    const std::int64_t bricks = whole_number(value->items[axis], "cuts");
    if (bricks < 1 || bricks > CutWish::kMost)
      table.fail("cuts", fmt::format("cuts: {} bricks along {}", bricks, kAxisNames[axis]), remedy);
    wish.bricks[axis] = static_cast<int>(bricks);
  }
  return wish;
}

Domain read_domain(const TableReader& root) {
  const TableReader table(*root.table("domain"), root.dimension(), "[domain]");
  const Box box = read_corners(table, "the domain");
  Domain domain;
  domain.place = table.place();
  domain.lo = box.lo;
  domain.hi = box.hi;
  for (const std::string& name : table.names("periodic")) {
    domain.periodic[axis_index(name, table.dimension(), table.place("periodic"))] = true;
  }
  read_outside(table, table.has("periodic"), domain);
  const std::string strip_axis = table.string("strip_axis");
  domain.strip_axis = strip_axis == "longest"
                          ? longest_axis(domain, table.dimension())
                          : axis_index(strip_axis, table.dimension(), table.place("strip_axis"));
  domain.cuts = read_cuts(table);
  return domain;
}

std::int64_t steps_until(const TableReader& table, double end, double step) {
  constexpr double kMaxSteps = 1e15;
  const double steps = end / step;
  if (!(steps < kMaxSteps)) {
    table.fail("end", fmt::format("end = {} s takes {} steps of {} s", end, steps, step),
               "at most 1e15 are possible");
  }
  if (steps < 0.5) {
    table.fail("end", fmt::format("end = {} s lies before the first step of {} s", end, step),
               "write a longer time, or steps = 0 to look at the start only");
  }
  return std::llround(steps);
}

TimeSpec read_time(const TableReader& root) {
  const TableReader table(*root.table("time"), root.dimension(), "[time]");
  TimeSpec time;
  time.step = table.number("step");
  time.place = table.place("step");
  time.allow_unstable = table.boolean("allow_unstable");
  if (!table.has_one_of("end", "steps")) {
    table.fail("", "[time] does not say when the run ends",
               "add end = <seconds> or steps = <number of steps>");
  }
  const auto end = table.optional_number("end");
  time.num_steps = end ? steps_until(table, *end, time.step) : *table.optional_integer("steps");
  return time;
}

Node empty_table(const TableReader& root) {
  Node node;
  node.file = std::make_shared<const std::string>(root.place().file);
  return node;
}

LimitSpec read_limits(const TableReader& table) {
  const auto limit = [&](std::string_view key) {
    const double share = table.number(key);
    return share > 0.0 ? share : std::numeric_limits<double>::infinity();
  };
  return {limit("overlap_warning"), limit("overlap_error")};
}

void read_options(const TableReader& root, Model& model) {
  const Node empty = empty_table(root);
  const auto node = [&](std::string_view key) { return root.has(key) ? root.table(key) : &empty; };
  const TableReader search(*node("search"), root.dimension(), "[search]");
  model.search.kind =
      search.string("kind") == "cells" ? ContactSearchKind::Cells : ContactSearchKind::AllPairs;
  model.search.skin = search.optional_number("skin");

  const TableReader exchange(*node("exchange"), root.dimension(), "[exchange]");
  model.exchange.depth =
      static_cast<int>(std::min<std::int64_t>(exchange.integer("depth"), kMostDepth + 1));
  model.exchange.place = exchange.place("depth");

  model.limits = read_limits(TableReader(*node("limits"), root.dimension(), "[limits]"));

  const TableReader output(*node("output"), root.dimension(), "[output]");
  model.output.series_every = output.integer("series_every");
  model.output.snapshots_every = output.integer("snapshots_every");
  model.output.picture = output.boolean("picture");
  model.output.energy = output.boolean("energy");

  const TableReader checkpoint(*node("checkpoint"), root.dimension(), "[checkpoint]");
  model.checkpoint.every_steps = checkpoint.integer("every_steps");
  model.checkpoint.every_seconds = checkpoint.number("every_seconds");
  constexpr std::int64_t kMost = std::numeric_limits<int>::max();
  model.checkpoint.keep = static_cast<int>(std::min(checkpoint.integer("keep"), kMost));
}

}  // namespace

void read_run_tables(const TableReader& root, DeckDraft& draft) {
  Model& model = draft.deck.model;
  model.title = root.optional_string("title").value_or("");
  model.gravity = root.vector("gravity");
  model.domain = read_domain(root);
  model.time = read_time(root);
  read_options(root, model);
}

void read_stages(const TableReader& root, DeckDraft& draft) {
  std::vector<Stage>& stages = draft.deck.model.stages;
  for (const Node* node : root.tables("stage")) {
    const TableReader table(*node, root.dimension(), "[[stage]]");
    Stage stage;
    stage.name = table.string("name");
    stage.local_damping = table.number("local_damping");
    stage.max_time = table.optional_number("max_time").value_or(stage.max_time);
    stage.kinetic_ratio = table.number("kinetic_ratio");
    draft.stages.add(stage.name, table.place("name"));
    stages.push_back(stage);
  }
  if (stages.empty()) {
    stages.push_back({});
    stages.back().name = "run";
    draft.stages.add("run", root.place());
  }
}

}  // namespace barchan::deck

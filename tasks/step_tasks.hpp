#pragma once

#include <cstdint>
#include <vector>

#include <barchan/tasks/cut_scheme.hpp>
#include <barchan/tasks/lane_map.hpp>

namespace barchan {

/// What a task of a step does. Begin and the arrivals are messages into the graph; End is who waits
/// for it.
enum class Work : std::uint8_t {
  Begin,
  Chunks,  ///< of a lane, one after the other; polls the exchange after each
  LeftBand,
  RightBand,
  Arrived,     ///< over a link
  Await,       ///< polls until the halos are in; where AwaitRight follows, until the left ones are
  AwaitRight,  ///< after the left band, until the right ones are
  End
};

/// One rank's lanes and what is beside them, from which its tasks follow.
struct GraphShape {
  struct LaneShape {
    int num_chunks = 0;
    std::vector<LaneTie> ties;
  };
  std::vector<LaneShape> lanes;
  CutForm form = CutForm::Strips;
  bool is_sequential = false;
  CutScheme scheme = CutScheme::BothSides;

  [[nodiscard]] int num_lanes() const { return static_cast<int>(lanes.size()); }
  [[nodiscard]] const std::vector<LaneTie>& ties(int lane) const {
    return lanes[static_cast<std::size_t>(lane)].ties;
  }
  /// Of strips where there is a cut; other bricks have both bands, though all their ties be on one
  /// side.
  [[nodiscard]] bool has_band(int lane, Side side) const;
  /// The band that is done last of what a tie leads to: then its halo goes.
  [[nodiscard]] Side sending_band(const LaneTie& tie) const {
    return form == CutForm::Strips ? tie.side : Side::Right;
  }
  /// Whether a band waits for a message of another rank, or sends one.
  [[nodiscard]] bool is_remote(int lane, Side side) const;
  /// Whether any lane waits for another rank on this side.
  [[nodiscard]] bool awaits(Side side) const;
  [[nodiscard]] int num_links() const;
  /// Whether the right neighbour answers what the left band makes known.
  [[nodiscard]] bool returns() const { return scheme == CutScheme::Returned; }
  [[nodiscard]] Work last_work(int lane) const {
    if (has_band(lane, Side::Right)) return Work::RightBand;
    return has_band(lane, Side::Left) ? Work::LeftBand : Work::Chunks;
  }
};

/// As a rank's lanes stand.
[[nodiscard]] GraphShape graph_shape(CutForm form, const std::vector<std::vector<LaneTie>>& ties);

struct StepTask {
  Work work = Work::Begin;
  int lane = 0;  ///< of chunks and bands; of Arrived the link

  friend bool operator==(const StepTask&, const StepTask&) = default;
};

enum class Way : std::uint8_t {
  Edge,    ///< of oneTBB; to End: its wait for all
  Message  ///< put into the graph when it is known to be true, which no edge can tell beforehand
};

struct StepArrow {
  int from = 0, to = 0;  ///< index of a task
  Way way = Way::Edge;
  bool is_next = false;   ///< to the task of the next step
  const char* note = "";  ///< when a message is put

  /// Of `to`, where the step of `from` has this one.
  [[nodiscard]] int parity_of_to(int parity) const { return is_next ? 1 - parity : parity; }
  friend bool operator==(const StepArrow&, const StepArrow&) = default;
};

struct StepTasks {
  std::vector<StepTask> tasks;
  std::vector<StepArrow> arrows;

  [[nodiscard]] int find(const StepTask& task) const;  ///< -1: there is none
};

/// One time step of one rank: its tasks and what each precedes. From this list come the edges of
/// oneTBB and the orders for ThreadSanitizer (task_graph.hpp), and the picture (graph_dot.hpp).
///
///     begin ─► chunks(l) ─► left(l) ─► right(l) ─► end              for every lane l
///                 ┆            ▲          ▲
///           polls ├┄┄► arrived(n)         │                     n: a link of the left band
///                 └┄┄► arrived(m) ────────┘                     m: a link of the right one
///
///   chunks(l)     precedes left(l) precedes right(l): a lane is one task's at a time
///   last(l)       precedes chunks(l) of the next step, be it the same run's or a later one's
///   arrived(n)    precedes the band that link n belongs to: a message, since MPI knows no edges
///   left(l)       of strips precedes right(l-1) of the next step, and right(l) left(l+1)
///   right(l)      of bricks precedes the bands of all lanes beside in the next step: it sends
///   chunks(all)   precede await, which polls until all halos are in
///   left(0)       precedes await_right, where the right neighbour answers the left band
///
/// A lone lane has nobody else to await halos: chunks ─► await ─► left ─► await_right ─► right.
/// A sequential step awaits halos first: begin ─► await ─► chunks. A rank without neighbours may
/// take several steps in a run: last(l) then also puts the message that the next step may begin.
[[nodiscard]] StepTasks step_tasks(const GraphShape& shape);

}  // namespace barchan

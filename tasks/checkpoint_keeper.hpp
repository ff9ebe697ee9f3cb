#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <barchan/comm/base/reduction.hpp>
#include <barchan/core/base/clock.hpp>
#include <barchan/core/checkpoint/checkpoint_folder.hpp>
#include <barchan/core/model/model.hpp>
#include <barchan/core/particles/share.hpp>
#include <barchan/tasks/run_events.hpp>

namespace barchan {

/// The state of one rank, copied between two steps.
struct CheckpointCopy {
  std::int64_t step = 0;
  double time = 0.0;
  double lo = 0.0, hi = 0.0;            ///< see ManifestFile
  std::vector<std::byte> state;         ///< rank 0; see state.hpp
  std::vector<CheckpointShare> shares;  ///< of the lanes
};

/// Writes checkpoints behind the steps:
///
///     every rank   copy ─► hash, write, fsync ─► agree ─┐
///                          (a thread)                   │
///     rank 0                                            └► manifest, fsync, rename, fsync, prune
///                                                          (a thread)
///
/// At most one checkpoint is under way: begin() waits for the end of the one before. The threads
/// call no MPI; poll(), between steps, does. A checkpoint that cannot be written gives a
/// warning; the checkpoints before it stay, and the run continues. Construction, begin, finish and
/// destruction are collective; rank 0 has the warnings.
class CheckpointKeeper {
 public:
  /// Removes what unfinished checkpoints an earlier run left. @param step  where the run stands
  CheckpointKeeper(const Communicator& communicator, std::string folder, const Model& model,
                   const CheckpointSpec& spec, std::int64_t step);
  ~CheckpointKeeper();
  CheckpointKeeper(const CheckpointKeeper&) = delete;
  CheckpointKeeper& operator=(const CheckpointKeeper&) = delete;

  /// By steps; the same on all ranks.
  [[nodiscard]] bool is_due(std::int64_t step) const;
  /// By the clock: what this rank thinks; all ranks must agree first.
  [[nodiscard]] bool is_overdue() const;

  void demand() { is_demanded_ = true; }  ///< a checkpoint, as all ranks agreed
  [[nodiscard]] bool is_demanded() const { return is_demanded_; }
  /// The run went back: what is on the disk of later steps may not be of this course.
  void forget_course() { is_of_course_ = false; }

  /// Waits for the checkpoint before. @return the memory to copy the state to
  CheckpointCopy& begin();
  /// The copy is made. Returns at once.
  void start();
  void poll();
  /// Waits for what is under way. @return false, on all ranks, when the last checkpoint begun is
  /// not on the disk
  bool finish();

  /// Step, -1 before the first.
  [[nodiscard]] std::int64_t last_begun() const { return is_of_course_ ? last_begun_ : -1; }
  /// Where the newest complete checkpoint of this run is; rank 0; empty before the first.
  [[nodiscard]] const std::string& last_complete() const { return last_complete_; }
  [[nodiscard]] std::vector<std::string> take_warnings();
  /// What became of checkpoints since the last call; rank 0.
  [[nodiscard]] std::vector<CheckpointEvent> take_events() { return std::exchange(events_, {}); }

 private:
  enum class Phase { Idle, Writing, Agreeing, Committing };
  void run_in_background(void (CheckpointKeeper::*work)());
  void join();
  void write_files();
  void commit();
  void begin_agreement();
  void take_agreement();
  void take_commit();
  void tell(const std::string& folder, const std::string& warning);
  void wait_idle();
  [[nodiscard]] std::vector<std::int64_t> numbers() const;
  [[nodiscard]] Manifest agreed_manifest() const;

  const Communicator& communicator_;
  CheckpointFolder folder_;
  std::string title_;
  std::vector<SourceRecord> sources_;
  CheckpointSpec spec_;
  std::int64_t first_step_;
  int dimension_;
  Reduction agreement_;
  CheckpointCopy copy_;
  Phase phase_ = Phase::Idle;

  std::thread thread_;
  std::atomic<bool> is_done_{false};
  int code_ = 0;  ///< errno of the thread's work, 0 when it went well; read after is_done_
  RankFileSeal seal_;

  bool is_demanded_ = false;
  std::int64_t last_begun_ = -1;
  bool is_of_course_ = true;
  bool last_is_good_ = false;
  std::string last_complete_;
  std::vector<std::string> warnings_;
  std::vector<CheckpointEvent> events_;
  std::int64_t last_time_ = now_ns();
  int num_exceptions_;
};

}  // namespace barchan

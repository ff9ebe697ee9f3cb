#include <barchan/tasks/checkpoint_keeper.hpp>

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>

#include <fmt/format.h>

#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/core/checkpoint/durable.hpp>
#include <barchan/tasks/agree.hpp>

namespace barchan {
namespace {

constexpr std::size_t kNumbers = 8;  // per rank, in the agreement
constexpr double kRankFactor =
    65536;  // code and rank in one number: the largest code wins, then the highest rank
constexpr int kUnknownCode = 4095;

/// The steps come first: on full cores this thread runs in their gaps.
void be_nice() {
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(::syscall(SYS_gettid)), 10);
}

template <class Work>
int code_of(Work&& work) {
  try {
    work();
    return 0;
  } catch (const FileError& e) {
    return e.code() > 0 ? e.code() : kUnknownCode;
  } catch (const std::bad_alloc&) {
    return ENOMEM;
  } catch (const std::exception&) {
    return kUnknownCode;
  }
}

std::string describe(int code) {
  return code == kUnknownCode ? "an unknown error" : std::strerror(code);
}

}  // namespace

CheckpointKeeper::CheckpointKeeper(const Communicator& communicator, std::string folder,
                                   const Model& model, const CheckpointSpec& spec,
                                   std::int64_t step)
    : communicator_(communicator),
      folder_(std::move(folder)),
      title_(model.title),
      sources_(model.sources),
      spec_(spec),
      first_step_(step),
      dimension_(model.dimension),
      agreement_(communicator, 1, kNumbers * static_cast<std::size_t>(communicator.size())),
      num_exceptions_(std::uncaught_exceptions()) {
  agree(communicator_, [this] {
    if (communicator_.is_root()) folder_.clean();
  });
}

CheckpointKeeper::~CheckpointKeeper() {
  try {
    if (is_mpi_initialized() && std::uncaught_exceptions() == num_exceptions_) wait_idle();
  } catch (const std::exception&) {  // the others are gone; what is not complete is not there
  }
  join();
}

bool CheckpointKeeper::is_due(std::int64_t step) const {
  return spec_.every_steps > 0 && step % spec_.every_steps == 0 && step != first_step_ &&
         step != last_begun();
}

bool CheckpointKeeper::is_overdue() const {
  if (!communicator_.is_root() || spec_.every_seconds <= 0.0) return false;
  return seconds_since(last_time_) >= spec_.every_seconds;
}

CheckpointCopy& CheckpointKeeper::begin() {
  wait_idle();
  is_demanded_ = false;
  last_time_ = now_ns();
  return copy_;
}

void CheckpointKeeper::start() {
  last_begun_ = copy_.step;
  is_of_course_ = true;
  last_is_good_ = false;
  phase_ = Phase::Writing;
  run_in_background(&CheckpointKeeper::write_files);
}

void CheckpointKeeper::run_in_background(void (CheckpointKeeper::*work)()) {
  is_done_ = false;
  const auto body = [this, work] {
    code_ = code_of([&] { (this->*work)(); });
    is_done_ = true;
  };
  try {
    thread_ = std::thread([body] {
      be_nice();
      body();
    });
  } catch (const std::system_error&) {  // no thread to be had
    body();
  }
}

void CheckpointKeeper::join() {
  if (thread_.joinable()) thread_.join();
}

void CheckpointKeeper::write_files() {
  folder_.begin(copy_.step);
  const auto rank = static_cast<std::size_t>(communicator_.rank());
  const RankFileHeader header{copy_.step, static_cast<std::uint32_t>(dimension_),
                              static_cast<std::uint32_t>(rank),
                              static_cast<std::uint32_t>(communicator_.size())};
  const std::string folder = folder_.unfinished(copy_.step);
  seal_ = write_rank_file(folder + "/" + rank_file_name(rank), header, copy_.state, copy_.shares);
  sync_folder(folder);
}

void CheckpointKeeper::commit() {
  folder_.commit(agreed_manifest());
  folder_.prune(copy_.step, spec_.keep);
}

void CheckpointKeeper::poll() {
  if (phase_ == Phase::Idle) return;
  if (phase_ == Phase::Agreeing) {
    if (agreement_.test()) take_agreement();
    return;
  }
  if (!is_done_) return;
  join();
  phase_ == Phase::Writing ? begin_agreement() : take_commit();
}

void CheckpointKeeper::wait_idle() {
  if (phase_ == Phase::Writing) {
    join();
    begin_agreement();
  }
  if (phase_ == Phase::Agreeing) {
    agreement_.wait(file_wait_limit());
    take_agreement();
  }
  if (phase_ == Phase::Committing) {
    join();
    take_commit();
  }
}

std::vector<std::int64_t> CheckpointKeeper::numbers() const {
  std::vector<std::int64_t> numbers(kNumbers * static_cast<std::size_t>(communicator_.size()), 0);
  std::int64_t* mine = numbers.data() + kNumbers * static_cast<std::size_t>(communicator_.rank());
  mine[0] = static_cast<std::int64_t>(seal_.bytes);
  mine[1] = std::bit_cast<std::int64_t>(seal_.hash);
  mine[2] = std::bit_cast<std::int64_t>(copy_.lo);
  mine[3] = std::bit_cast<std::int64_t>(copy_.hi);
  for (const CheckpointShare& share : copy_.shares) {
    mine[4] += static_cast<std::int64_t>(share.ids.size());
    mine[5] += static_cast<std::int64_t>(share.contact_ids.size() / 2);
    mine[6] += static_cast<std::int64_t>(share.wall_contact_ids.size());
    mine[7] += static_cast<std::int64_t>(share.bond_laws.size());
  }
  return numbers;
}

Manifest CheckpointKeeper::agreed_manifest() const {
  Manifest manifest{copy_.step, copy_.time, dimension_, title_, {}, sources_};
  const auto numbers = agreement_.sums();
  for (std::size_t r = 0; r < static_cast<std::size_t>(communicator_.size()); ++r) {
    const auto of_rank = numbers.subspan(kNumbers * r, kNumbers);
    const RankFileSeal seal{static_cast<std::uint64_t>(of_rank[0]),
                            std::bit_cast<std::uint64_t>(of_rank[1])};
    manifest.files.push_back({seal, std::bit_cast<double>(of_rank[2]),
                              std::bit_cast<double>(of_rank[3]), of_rank[4], of_rank[5], of_rank[6],
                              of_rank[7]});
  }
  return manifest;
}

void CheckpointKeeper::begin_agreement() {
  const double failure = code_ == 0 ? 0.0 : code_ * kRankFactor + communicator_.rank();
  agreement_.begin(std::span(&failure, 1), numbers());
  phase_ = Phase::Agreeing;
}

void CheckpointKeeper::take_agreement() {
  const auto failure = static_cast<std::int64_t>(agreement_.maxima()[0]);
  phase_ = Phase::Idle;
  if (!communicator_.is_root()) return;
  if (failure == 0) {
    phase_ = Phase::Committing;
    run_in_background(&CheckpointKeeper::commit);
    return;
  }
  folder_.discard(copy_.step);
  const auto factor = static_cast<std::int64_t>(kRankFactor);
  tell("", fmt::format("the checkpoint of step {} could not be written: rank {}, {}: {}; {}",
                       copy_.step, failure % factor, folder_.path(),
                       describe(static_cast<int>(failure / factor)),
                       last_complete_.empty() ? "there is none before it"
                                              : "the one before, " + last_complete_ + ", stays"));
}

void CheckpointKeeper::take_commit() {
  phase_ = Phase::Idle;
  const std::string path = folder_.complete(copy_.step);
  std::error_code ignored;
  last_is_good_ = code_ == 0 || std::filesystem::exists(path + "/" + kManifestName, ignored);
  if (last_is_good_) last_complete_ = path;
  if (code_ == 0) return tell(path, "");
  if (!last_is_good_) folder_.discard(copy_.step);
  tell(last_is_good_ ? path : "",
       fmt::format("the checkpoint of step {} {}: {}: {}", copy_.step,
                   last_is_good_ ? "is complete, but older ones could not be removed"
                                 : "could not be finished",
                   folder_.path(), describe(code_)));
}

/// Events that nobody takes are not many: one a checkpoint.
void CheckpointKeeper::tell(const std::string& folder, const std::string& warning) {
  if (!warning.empty()) warnings_.push_back(warning);
  events_.push_back({copy_.step, folder, warning});
}

bool CheckpointKeeper::finish() {
  wait_idle();
  return last_begun_ < 0 || communicator_.any_of(last_is_good_);
}

std::vector<std::string> CheckpointKeeper::take_warnings() {
  return std::exchange(warnings_, {});
}

}  // namespace barchan

#include <barchan/tasks/results/run_results.hpp>

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/results/check_sums.hpp>
#include <barchan/tasks/results/departure_table.hpp>
#include <barchan/tasks/results/final_picture.hpp>

namespace barchan {
namespace {

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

std::int64_t next_multiple(std::int64_t step, std::int64_t every) {
  return every == kNever ? kNever : (step / every + 1) * every;
}

/// Rows of a series unless the deck says how often.
std::int64_t series_interval(const Model& model) {
  if (model.output.series_every > 0) return model.output.series_every;
  return std::max<std::int64_t>(1, model.time.num_steps / 100);
}

}  // namespace

RunResults::RunResults(Simulation& simulation, RunFolder folder, const ParticleSet& particles,
                       ResultsSpec spec)
    : simulation_(simulation),
      folder_(std::move(folder)),
      spec_(std::move(spec)),
      series_every_(series_interval(simulation.model())),
      snapshots_every_(simulation.model().output.snapshots_every),
      snapshots_(folder_.file("snapshots")) {
  if (snapshots_every_ <= 0) snapshots_every_ = kNever;
  const bool continues = spec_.continues;
  on_rank_zero([&] { continues ? folder_.resume() : folder_.begin(); });
  series_.emplace(simulation, folder_.file("series.csv"), spec_.rings, continues);
  list_departures();
  if (continues) on_rank_zero([&] { folder_.reopen(); });
  log_.emplace(simulation, folder_.file("log.txt"), continues);
  for (const std::string& note : particles.notes) log_->warn(note);
  if (continues) {
    if (const auto damage = series_->damage(simulation, series_every_); !damage.empty())
      log_->warn(damage);
    snapshots_.resume(simulation, snapshots_every_);
    write();
    return;
  }
  append_row();
  snapshots_.write(simulation);
}

/// What cannot be told in numbers is still a row.
void RunResults::append_row() {
  const Measures measures = series_->append(simulation_);
  last_row_ = simulation_.step();
  check_sums(simulation_, measures);
}

std::int64_t RunResults::next_step() const {
  const std::int64_t step = simulation_.step();
  return std::min(next_multiple(step, series_every_), next_multiple(step, snapshots_every_));
}

void RunResults::on_rank_zero(const std::function<void()>& work) {
  agree(simulation_.communicator(), [&] {
    if (simulation_.communicator().is_root()) work();
  });
}

void RunResults::list_departures() {
  on_rank_zero([&] {
    const DepartureTable table(folder_.file("left_domain.csv"), simulation_.model().dimension,
                               simulation_.step());
    simulation_.on_departure([table](std::span<const Departure> left) { table.append(left); });
  });
}

void RunResults::write_failed() {
  const std::int64_t step = simulation_.step();
  log_->take_notes(simulation_);
  if (step != last_row_) series_->append(simulation_);
  if (step != snapshots_.last_step()) snapshots_.write(simulation_);
}

void RunResults::write() {
  const std::int64_t step = simulation_.step();
  log_->take_notes(simulation_);
  if (step % series_every_ == 0 && step != last_row_) append_row();
  if (step % snapshots_every_ == 0 && step != snapshots_.last_step()) snapshots_.write(simulation_);
}

RunSummary RunResults::finish(bool interrupted) {
  const std::int64_t step = simulation_.step();
  log_->take_notes(simulation_);
  if (step != last_row_) append_row();
  if (step != snapshots_.last_step()) snapshots_.write(simulation_);
  if (simulation_.model().output.picture)
    write_final_picture(simulation_, folder_.file("picture.png"));
  RunSummary summary = summarize(simulation_, spec_.deck, spec_.limit, interrupted);
  summary.deck_keys = spec_.deck_keys;
  on_rank_zero([&] { write_run_json(folder_.file("run.json"), summary); });
  log_->add(fmt::format("{} at step {}", interrupted ? "interrupted" : "done", step));
  return summary;
}

}  // namespace barchan

#include <barchan/tasks/simulation.hpp>

#include <atomic>
#include <stdexcept>
#include <utility>

#include <barchan/core/error.hpp>
#include <barchan/tasks/engine.hpp>
#include <barchan/tasks/stop_request.hpp>

namespace barchan {
namespace {

std::atomic<bool> stop_requested{false}, checkpoint_requested{false};

}  // namespace

bool stop_is_requested() noexcept {
  return stop_requested.load(std::memory_order_relaxed);
}

void Simulation::request_stop() noexcept {
  stop_requested.store(true, std::memory_order_relaxed);
}

bool checkpoint_is_requested() noexcept {
  return checkpoint_requested.load(std::memory_order_relaxed);
}

void forget_checkpoint_request() noexcept {
  checkpoint_requested.store(false, std::memory_order_relaxed);
}

void Simulation::request_checkpoint() noexcept {
  checkpoint_requested.store(true, std::memory_order_relaxed);
}

std::vector<std::string> exchange_choices() {
  std::vector<std::string> names{"auto"};
  for (auto& name : exchange_names()) names.push_back(std::move(name));
  names.emplace_back("return");
  return names;
}

Simulation::Simulation(const Model& model, const ParticleSet& particles, Communicator communicator,
                       const RunOptions& options) {
  if (model.dimension == 2)
    engine_ = std::make_unique<EngineOf<2>>(model, particles, std::move(communicator), options);
  else if (model.dimension == 3)
    engine_ = std::make_unique<EngineOf<3>>(model, particles, std::move(communicator), options);
  else
    throw InputError("dimension " + std::to_string(model.dimension), "2 or 3");
}

Simulation::Simulation(std::unique_ptr<Engine> engine) : engine_(std::move(engine)) {}

Simulation Simulation::restore(const Model& model, const std::string& checkpoint,
                               Communicator communicator, const RunOptions& options) {
  if (model.dimension == 2)
    return Simulation(
        std::make_unique<EngineOf<2>>(model, checkpoint, std::move(communicator), options));
  if (model.dimension == 3)
    return Simulation(
        std::make_unique<EngineOf<3>>(model, checkpoint, std::move(communicator), options));
  throw InputError("dimension " + std::to_string(model.dimension), "2 or 3");
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

std::int64_t Simulation::run(std::int64_t num_steps) {
  return engine_->run(num_steps);
}
bool Simulation::stopped() const {
  return engine_->stopped_;
}
std::int64_t Simulation::step() const {
  return engine_->step_;
}
double Simulation::time() const {
  return static_cast<double>(engine_->step_) * engine_->model_.time.step;
}
int Simulation::stage() const {
  return engine_->stage_;
}
const Model& Simulation::model() const {
  return engine_->model_;
}
const RunOptions& Simulation::options() const {
  return engine_->options_;
}
std::string Simulation::vector_width() const {
  return engine_->vector_width();
}
const Communicator& Simulation::communicator() const {
  return engine_->communicator_;
}
void Simulation::for_each_owned(const std::function<void(const OwnedParticle&)>& visit) const {
  engine_->for_each_owned(visit);
}
std::int64_t Simulation::num_owned() const {
  return engine_->num_owned();
}
std::int64_t Simulation::num_particles() const {
  return engine_->num_particles_;
}
const LeftDomain& Simulation::left_domain() const {
  return engine_->left_;
}
void Simulation::on_departure(std::function<void(std::span<const Departure>)> tell) {
  engine_->tell_departures_ = std::move(tell);
}
std::vector<Note> Simulation::take_notes() {
  return std::exchange(engine_->notes_, {});
}
void Simulation::apply_forces(const std::function<Vec3(const OwnedParticle&)>& force) {
  engine_->apply_forces(force);
}
void Simulation::clear_forces() {
  engine_->clear_forces();
}
Measures Simulation::measure() {
  return engine_->measure();
}
std::span<const WallState> Simulation::walls() const {
  return engine_->walls();
}
std::uint64_t Simulation::digest() {
  return engine_->digest();
}
void Simulation::keep_checkpoints(const std::string& folder, const CheckpointSpec& spec) {
  engine_->keeper_ = std::make_unique<CheckpointKeeper>(engine_->communicator_, folder,
                                                        engine_->model_, spec, engine_->step_);
}
void Simulation::save_checkpoint() {
  if (engine_->keeper_->last_begun() != engine_->step_) engine_->save_checkpoint();
}
bool Simulation::finish_checkpoints() {
  return engine_->keeper_ == nullptr || engine_->keeper_->finish();
}
std::vector<std::string> Simulation::take_checkpoint_warnings() {
  return engine_->keeper_ ? engine_->keeper_->take_warnings() : std::vector<std::string>{};
}
std::string Simulation::last_checkpoint() const {
  return engine_->keeper_ ? engine_->keeper_->last_complete() : "";
}
Timings Simulation::timings() const {
  return engine_->timings();
}
const ExchangeChoice& Simulation::exchange_choice() const {
  return engine_->choice_;
}
std::string Simulation::step_graph() const {
  return graph_dot(engine_->communicator_, engine_->graph_shape());
}
void Simulation::write_trace(const std::string& path) const {
  if (!engine_->trace_) throw std::logic_error("Simulation::write_trace: RunOptions::trace is off");
  engine_->trace_->write(path);
}
double Simulation::skin() const {
  return engine_->skin();
}
std::size_t Simulation::memory_bytes() const {
  return engine_->memory_bytes();
}

}  // namespace barchan

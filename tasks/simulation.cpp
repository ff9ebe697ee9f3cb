#include <barchan/tasks/simulation.hpp>

#include <atomic>
#include <exception>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/comm/exchanges/make_exchange.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/model/validate.hpp>
#include <barchan/tasks/check_input.hpp>
#include <barchan/tasks/engine.hpp>
#include <barchan/tasks/graph_dot.hpp>
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

void forget_stop_request() noexcept {
  stop_requested.store(false, std::memory_order_relaxed);
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
  check_input(communicator, model, particles, options);
  if (model.dimension == 2)
    engine_ = std::make_unique<EngineOf<2>>(model, particles, std::move(communicator), options);
  else
    engine_ = std::make_unique<EngineOf<3>>(model, particles, std::move(communicator), options);
}

Simulation::Simulation(std::unique_ptr<Engine> engine) : engine_(std::move(engine)) {}

Simulation Simulation::restore(const Model& model, const std::string& checkpoint,
                               Communicator communicator, const RunOptions& options) {
  check_input(communicator, model, checkpoint, options);
  const OpenCheckpoint open = open_checkpoint(communicator, checkpoint, model);
  if (model.dimension == 2)
    return Simulation(std::make_unique<EngineOf<2>>(model, open, std::move(communicator), options));
  return Simulation(std::make_unique<EngineOf<3>>(model, open, std::move(communicator), options));
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

Simulation::Engine& Simulation::engine() const {
  if (engine_ == nullptr) throw std::logic_error("Simulation: used after it was moved from");
  return *engine_;
}

Simulation::Engine& Simulation::between_steps(const char* call) const {
  Engine& engine = this->engine();
  if (!is_mpi_initialized())
    throw RunError(fmt::format("Simulation::{}: MPI has ended: call it before that", call));
  if (!engine.is_in_step_ && engine.telling_ == Engine::Telling::Nothing) return engine;
  if (engine.failure_)
    throw RunError(
        fmt::format("Simulation::{}: the run failed in the midst of step {}: begin again "
                    "from a checkpoint",
                    call, engine.step_));
  throw std::logic_error(
      fmt::format("Simulation::{}: called from within run(): call it after run() returned", call));
}

Simulation::Engine& Simulation::at_rest(const char* call) const {
  Engine& engine = this->engine();
  return engine.telling_ == Engine::Telling::OnOneThread ? engine : between_steps(call);
}

std::int64_t Simulation::run(std::int64_t num_steps) {
  if (num_steps < 0)
    throw std::invalid_argument(fmt::format("Simulation::run: {} steps", num_steps));
  Engine& engine = this->engine();
  if (engine.failure_) std::rethrow_exception(engine.failure_);
  return between_steps("run").run(num_steps);
}
bool Simulation::stopped() const {
  return engine().stopped_ || engine().is_over_;
}
bool Simulation::is_over() const {
  return engine().is_over_;
}
bool Simulation::is_in_callback() const {
  return engine().is_in_step_ || engine().telling_ != Engine::Telling::Nothing;
}
std::int64_t Simulation::step() const {
  return engine().step_;
}
double Simulation::time() const {
  return engine().time();
}
int Simulation::stage() const {
  return engine().stages_.current();
}
const Model& Simulation::model() const {
  return engine().model_;
}
const RunOptions& Simulation::options() const {
  return engine().options_;
}
std::string Simulation::vector_width() const {
  return engine().vector_width();
}
const Communicator& Simulation::communicator() const {
  return engine().communicator_;
}
void Simulation::for_each_owned(const std::function<void(const OwnedParticle&)>& visit) const {
  engine().for_each_owned(visit);
}
void Simulation::for_each_bond(const BondVisitor& visit) {
  between_steps("for_each_bond").for_each_bond(visit);
}
std::int64_t Simulation::num_owned() const {
  return engine().num_owned();
}
std::int64_t Simulation::num_particles() const {
  return engine().population_.size;
}
const LeftDomain& Simulation::left_domain() const {
  return engine().population_.left;
}
std::vector<Note> Simulation::take_notes() {
  return engine().notes_.take();
}
void Simulation::apply_forces(const std::function<Vec3(const OwnedParticle&)>& force) {
  at_rest("apply_forces").apply_forces(force);
}
void Simulation::clear_forces() {
  at_rest("clear_forces").clear_forces();
}
EnergyBudget Simulation::energy_budget(const Measures& measured) const {
  if (!model().output.energy)
    throw InputError("no account of energy is kept", "set output.energy = true before the run");
  double work = 0.0;
  for (const WallState& wall : walls()) work += wall.work;
  return budget_of(measured, work);
}

Measures Simulation::measure() {
  return between_steps("measure").measure();
}
std::span<const WallState> Simulation::walls() const {
  return engine().walls();
}
std::uint64_t Simulation::digest() {
  return between_steps("digest").digest();
}
void Simulation::keep_checkpoints(const std::string& folder, const CheckpointSpec& spec) {
  validate(spec);
  Engine& engine = between_steps("keep_checkpoints");
  engine.keeper_ = nullptr;  // the former one ends its work first
  engine.keeper_ = std::make_unique<CheckpointKeeper>(engine.communicator_, folder, engine.model_,
                                                      spec, engine.step_);
}
void Simulation::save_checkpoint() {
  Engine& engine = between_steps("save_checkpoint");
  if (engine.keeper_ == nullptr)
    throw std::logic_error("Simulation::save_checkpoint: call keep_checkpoints first");
  if (engine.keeper_->last_begun() != engine.step_) engine.save_checkpoint();
}
bool Simulation::finish_checkpoints() {
  return engine().keeper_ == nullptr || engine().keeper_->finish();
}
std::vector<std::string> Simulation::take_checkpoint_warnings() {
  return engine().keeper_ ? engine().keeper_->take_warnings() : std::vector<std::string>{};
}
std::string Simulation::last_checkpoint() const {
  const Engine& engine = this->engine();
  if (!engine.communicator_.is_root()) return "";
  const std::string newest = engine.keeper_ ? engine.keeper_->last_complete() : "";
  return newest.empty() ? engine.restored_from_ : newest;
}
Timings Simulation::timings() const {
  return engine().timings();
}
const ExchangeChoice& Simulation::exchange_choice() const {
  return engine().choice_;
}
CutsInUse Simulation::cuts() const {
  return engine().cuts();
}
std::string Simulation::step_graph() const {
  return graph_dot(engine().communicator_, engine().graph_shape());
}
void Simulation::write_trace(const std::string& path) const {
  if (!engine().trace_) throw std::logic_error("Simulation::write_trace: RunOptions::trace is off");
  engine().trace_->write(path);
}
double Simulation::skin() const {
  return engine().skin();
}

double Simulation::force_grain() const {
  return engine_->force_grain();
}
std::size_t Simulation::memory_bytes() const {
  return engine().memory_bytes();
}

}  // namespace barchan

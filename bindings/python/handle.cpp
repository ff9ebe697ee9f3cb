#include "handle.hpp"

#include <stdexcept>

namespace barchan::python {

Handle::Turn::Turn(Handle& handle) : handle_(handle) {
  is_nested_ = handle.is_busy_ && handle.caller_ == std::this_thread::get_id();
  if (is_nested_) return;
  if (handle.is_busy_.exchange(true))
    throw std::runtime_error("another thread is in a call of this simulation: one at a time");
  handle.caller_ = std::this_thread::get_id();
  if (!handle.is_closed()) return;
  end();
  throw std::runtime_error("the simulation was closed");
}

Handle::Turn::~Turn() {
  if (!is_nested_) end();
}

void Handle::Turn::end() {
  handle_.caller_ = std::thread::id();
  handle_.is_busy_ = false;
}

std::vector<BrickOfMoment> Handle::owned() {
  const Turn turn(*this);
  return bricks_of_moment();
}

std::vector<BrickOfMoment> Handle::bricks_of_moment() {
  if (moment_ == nullptr) moment_ = std::make_shared<Moment>(Moment{simulation_, {}, {}});
  std::vector<BrickOfMoment> bricks;
  for (ParticleView& view : simulation_->owned())
    bricks.emplace_back(std::move(view), bricks.size(), moment_);
  return bricks;
}

/// Whoever still has arrays keeps their memory; nobody writes to it any more.
void Handle::end_moment() {
  if (moment_ == nullptr) return;
  const std::shared_ptr<Moment> over = std::move(moment_);
  moment_ = nullptr;
  over->is_over = true;
  if (over.use_count() > 1) over->released = simulation_->release_arrays();
  over->simulation = nullptr;
  for (const py::weakref& weak : over->writeable) {
    const py::object array = weak();
    if (!array.is_none()) array.attr("flags").attr("writeable") = false;
  }
  over->writeable.clear();
}

void Handle::close() {
  if (is_closed()) return;
  if (is_busy_ && caller_ == std::this_thread::get_id())
    throw std::runtime_error("a callback may not close its simulation");
  if (is_busy_.exchange(true))
    throw std::runtime_error("another thread is in a call of this simulation: close it later");
  end_moment();
  simulation_ = nullptr;
  is_busy_ = false;
}

const ParticleView& BrickOfMoment::view() const {
  if (moment_->is_over)
    throw StaleView(
        "this view is of a moment that is over: take a new one with owned() after run(), load() "
        "and other calls that change particles");
  return view_;
}

LoadView BrickOfMoment::loads() const {
  (void)view();
  return moment_->simulation->loads().at(brick_);
}

StridedSpan<double> BrickOfMoment::field(const std::string& name) const {
  (void)view();
  return moment_->simulation->field(name).at(brick_).values();
}

py::capsule BrickOfMoment::keeper() const {
  return {new std::shared_ptr<Moment>(moment_),
          [](void* moment) { delete static_cast<std::shared_ptr<Moment>*>(moment); }};
}

py::array BrickOfMoment::writeable_array(const StridedSpan<double>& span) const {
  const StridedSpan<const double> readable(span.data(), span.size(), span.width(), span.stride());
  py::array array = this->array(readable, true);
  moment_->writeable.emplace_back(array);
  return array;
}

}  // namespace barchan::python

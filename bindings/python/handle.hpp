#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <barchan/tasks/simulation.hpp>

namespace barchan::python {

namespace py = pybind11;

/// What keeps the memory of arrays: while they are of the present moment, the simulation; from then
/// on what it has released.
struct Moment {
  std::shared_ptr<Simulation> simulation;
  std::shared_ptr<const void> released;
  std::vector<py::weakref> writeable;  ///< arrays that may be written until the moment is over
  bool is_over = false;
};

class BrickOfMoment;

/// A simulation as Python sees it. Views are of a moment, which every call that moves or changes
/// particles ends; arrays that outlive it keep its values.
class Handle {
 public:
  explicit Handle(Simulation&& simulation)
      : simulation_(std::make_shared<Simulation>(std::move(simulation))) {}
  ~Handle() { close(); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  /// Calls work(simulation) without the interpreter's lock; refuses a second thread meanwhile.
  template <class Work>
  auto call(Work&& work) {
    const Turn turn(*this);
    const py::gil_scoped_release free;
    return work(*simulation_);
  }
  /// The same for what ends the moment.
  template <class Work>
  auto change(Work&& work) {
    const Turn turn(*this);
    end_moment();
    const py::gil_scoped_release free;
    return work(*simulation_);
  }
  [[nodiscard]] std::vector<BrickOfMoment> owned();
  /// Within a callback of run(): the bricks for it, and its end.
  [[nodiscard]] std::vector<BrickOfMoment> bricks_of_moment();
  void end_moment();
  void close();
  [[nodiscard]] bool is_closed() const { return simulation_ == nullptr; }

 private:
  /// One thread at a time, and callbacks of run() on its thread. Errors: std::runtime_error
  class Turn {
   public:
    explicit Turn(Handle& handle);
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    void end();
    Handle& handle_;
    bool is_nested_ = false;
  };

  std::shared_ptr<Simulation> simulation_;
  std::shared_ptr<Moment> moment_;  ///< null: nobody has asked for arrays since the last change
  std::atomic<bool> is_busy_{false};
  std::atomic<std::thread::id> caller_{};  ///< of the call that keeps it busy
};

/// Particles of a brick at a moment.
class BrickOfMoment {
 public:
  BrickOfMoment(ParticleView view, std::size_t brick, std::shared_ptr<Moment> moment)
      : view_(std::move(view)), brick_(brick), moment_(std::move(moment)) {}

  [[nodiscard]] const ParticleView& view() const;  ///< Errors: StaleView
  [[nodiscard]] LoadView loads() const;            ///< Errors: StaleView
  /// Errors: StaleView; std::invalid_argument: there is no such field
  [[nodiscard]] StridedSpan<double> field(const std::string& name) const;
  /// (particles, components); of one component (particles).
  template <class T>
  [[nodiscard]] py::array array(const StridedSpan<const T>& span, bool is_writeable = false) const;
  /// Until the moment is over.
  [[nodiscard]] py::array writeable_array(const StridedSpan<double>& span) const;

 private:
  [[nodiscard]] py::capsule keeper() const;

  ParticleView view_;
  std::size_t brick_;
  std::shared_ptr<Moment> moment_;
};

template <class T>
py::array BrickOfMoment::array(const StridedSpan<const T>& span, bool is_writeable) const {
  constexpr auto kBytes = static_cast<py::ssize_t>(sizeof(T));
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(span.size())},
      strides{static_cast<py::ssize_t>(span.stride()) * kBytes};
  if (span.width() > 1) {
    shape.push_back(span.width());
    strides.push_back(kBytes);
  }
  py::array_t<T> array(shape, strides, span.data(), keeper());
  if (!is_writeable) array.attr("flags").attr("writeable") = false;
  return array;
}

void define_calls(py::module_& module);
void define_events(py::class_<Handle>& simulation);

}  // namespace barchan::python

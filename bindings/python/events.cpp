// Callbacks of run() that are functions of Python.
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "handle.hpp"

namespace barchan::python {
namespace {

using Function = std::shared_ptr<py::function>;

/// Kept by threads that do not have the interpreter's lock.
Function hold(py::function function) {
  return {new py::function(std::move(function)), [](const py::function* held) {
            const py::gil_scoped_acquire lock;
            delete held;
          }};
}

/// The first line of what a callback raised, and where.
std::string words_of(const py::error_already_set& error) {
  const std::string text = error.what();
  const std::size_t line = text.find('\n'), at = text.find("\nAt:\n  ");
  std::string words = text.substr(0, line);
  if (at == std::string::npos) return words;
  const std::size_t begin = at + 7, end = text.find('\n', begin);
  return words + " at " + text.substr(begin, end == std::string::npos ? end : end - begin);
}

/// Calls work() with the interpreter's lock. Errors: std::runtime_error: what Python raised
template <class Work>
void with_python(Work&& work) {
  const py::gil_scoped_acquire lock;
  try {
    work();
  } catch (const py::error_already_set& error) {
    throw std::runtime_error(words_of(error));
  }
}

/// Null where Python gives None.
template <class Make>
auto unless_none(const py::object& function, Make&& make)
    -> decltype(make(std::declval<Function>())) {
  if (function.is_none()) return {};
  return make(hold(function.cast<py::function>()));
}

std::tuple<double, double, double> three(const double (&v)[3]) {
  return {v[0], v[1], v[2]};
}

void on_step(Handle& h, std::int64_t every, const py::object& function) {
  using Call = std::function<void(std::span<const ParticleView>)>;
  const Call call = unless_none(function, [&h](Function f) -> Call {
    return [&h, f](std::span<const ParticleView>) {
      with_python([&] {
        try {
          (*f)(h.bricks_of_moment());
        } catch (...) {
          h.end_moment();
          throw;
        }
        h.end_moment();
      });
    };
  });
  h.call([&](Simulation& s) { s.on_step_together(every, call); });
}

void on_progress(Handle& h, std::int64_t every, const py::object& function) {
  using Call = std::function<void(const RunProgress&)>;
  const Call call = unless_none(function, [](Function f) -> Call {
    return [f](const RunProgress& now) { with_python([&] { (*f)(now.step, now.time); }); };
  });
  h.call([&](Simulation& s) { s.on_progress(every, call); });
}

void on_note(Handle& h, const py::object& function) {
  using Call = std::function<void(const Note&)>;
  const Call call = unless_none(function, [](Function f) -> Call {
    return [f](const Note& note) { with_python([&] { (*f)(note.text, note.is_warning); }); };
  });
  h.call([&](Simulation& s) { s.on_note(call); });
}

void on_checkpoint(Handle& h, const py::object& function) {
  using Call = std::function<void(const CheckpointEvent&)>;
  const Call call = unless_none(function, [](Function f) -> Call {
    return [f](const CheckpointEvent& event) {
      with_python([&] { (*f)(event.step, event.folder, event.error); });
    };
  });
  h.call([&](Simulation& s) { s.on_checkpoint(call); });
}

void on_bond_breaks(Handle& h, const py::object& function) {
  using Call = std::function<void(std::span<const BondBreak>)>;
  const Call call = unless_none(function, [](Function f) -> Call {
    return [f](std::span<const BondBreak> breaks) {
      with_python([&] {
        py::list all;
        for (const BondBreak& b : breaks) all.append(py::make_tuple(b.step, b.id_a, b.id_b));
        (*f)(all);
      });
    };
  });
  h.call([&](Simulation& s) { s.on_bond_breaks(call); });
}

void on_departure(Handle& h, const py::object& function) {
  using Call = std::function<void(std::span<const Departure>)>;
  const Call call = unless_none(function, [](Function f) -> Call {
    return [f](std::span<const Departure> left) {
      with_python([&] {
        py::list all;
        for (const Departure& d : left)
          all.append(py::make_tuple(d.step, d.id, three(d.position), three(d.velocity)));
        (*f)(all);
      });
    };
  });
  h.call([&](Simulation& s) { s.on_departure(call); });
}

}  // namespace

void define_events(py::class_<Handle>& simulation) {
  simulation.def("on_step", &on_step)
      .def("on_progress", &on_progress)
      .def("on_note", &on_note)
      .def("on_checkpoint", &on_checkpoint)
      .def("on_bond_breaks", &on_bond_breaks)
      .def("on_departure", &on_departure);
}

}  // namespace barchan::python

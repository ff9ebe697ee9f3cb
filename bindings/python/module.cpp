// barchan._barchan: what the package barchan stands on; barchan/simulation.py documents it.
#include <cstring>

#include <barchan/comm/base/fortran_handle.hpp>
#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/tasks/open_deck.hpp>

#include "handle.hpp"

namespace barchan::python {
namespace {

using Overrides = std::vector<std::pair<std::string, std::string>>;

struct Opening {
  std::string path, text, checkpoint;
  Overrides overrides;
  int comm = 0, threads = 0;
  std::string exchange, vector, schedule;
};

std::unique_ptr<Handle> open(const Opening& opening) {
  RunOptions options;
  options.threads = opening.threads;
  options.exchange = opening.exchange;
  options.vector = opening.vector;
  options.schedule = opening.schedule == "sequential" ? Schedule::Sequential : Schedule::Overlap;
  DeckSource source{opening.path, opening.text};
  for (const auto& [key, value] : opening.overrides) source.overrides.push_back({key, value});
  const py::gil_scoped_release free;
  return std::make_unique<Handle>(
      open_deck(source, communicator_of(opening.comm), options, opening.checkpoint));
}

py::dict columns_of(const ParticleFile& file) {
  const auto n = static_cast<py::ssize_t>(file.particles.size());
  py::array_t<std::int64_t> id(n);
  py::array_t<std::int32_t> type(n);
  py::array_t<double> radius(n), density(n), position({n, py::ssize_t{3}}),
      velocity({n, py::ssize_t{3}}), omega({n, py::ssize_t{3}});
  for (py::ssize_t i = 0; i < n; ++i) {
    const ParticleData& p = file.particles[static_cast<std::size_t>(i)];
    id.mutable_at(i) = p.id;
    type.mutable_at(i) = p.type;
    radius.mutable_at(i) = p.radius;
    density.mutable_at(i) = p.density;
    for (int c = 0; c < 3; ++c) {
      position.mutable_at(i, c) = p.position[c];
      velocity.mutable_at(i, c) = p.velocity[c];
      omega.mutable_at(i, c) = p.omega[c];
    }
  }
  using namespace py::literals;
  return py::dict("id"_a = id, "type"_a = type, "radius"_a = radius, "density"_a = density,
                  "position"_a = position, "velocity"_a = velocity, "omega"_a = omega);
}

void define_errors(py::module_& m) {
  static py::exception<InputError> input(m, "InputError", PyExc_ValueError);
  static py::exception<RunError> run(m, "RunError", PyExc_RuntimeError);
  static py::exception<AgreedError> ended(m, "RunEnded", run);
  static py::exception<StaleView> stale(m, "StaleView", PyExc_RuntimeError);
  for (py::handle kind : {py::handle(input), py::handle(run), py::handle(ended), py::handle(stale)})
    kind.attr("__module__") = "barchan";  // where users find them
  py::register_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const InputError& e) {
      input(e.what());
    } catch (const AgreedError& e) {
      ended(e.what());
    } catch (const RunError& e) {
      run(e.what());
    } catch (const StaleView& e) {
      stale(e.what());
    }
  });
}

}  // namespace
}  // namespace barchan::python

PYBIND11_MODULE(_barchan, m) {
  using namespace barchan::python;
  m.doc() = "The compiled part of barchan; use the package.";
  m.attr("version") = BARCHAN_VERSION;
  define_errors(m);
  m.def("start_mpi", [] { static const barchan::MpiSession session; });
  m.def("is_mpi_running", &barchan::is_mpi_initialized);
  m.def("world", &barchan::world_handle);
  m.def("read_particles",
        [](const std::string& path) { return columns_of(barchan::read_particles(path)); });
  py::class_<Opening>(m, "Opening")
      .def(py::init<>())
      .def_readwrite("path", &Opening::path)
      .def_readwrite("text", &Opening::text)
      .def_readwrite("checkpoint", &Opening::checkpoint)
      .def_readwrite("overrides", &Opening::overrides)
      .def_readwrite("comm", &Opening::comm)
      .def_readwrite("threads", &Opening::threads)
      .def_readwrite("exchange", &Opening::exchange)
      .def_readwrite("vector", &Opening::vector)
      .def_readwrite("schedule", &Opening::schedule);
  m.def("open", &open);
  define_calls(m);
}

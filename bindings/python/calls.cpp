// The calls of a simulation, without ornament: barchan/simulation.py has names, defaults and words.
#include <array>
#include <map>
#include <stdexcept>
#include <string>

#include <barchan/core/model/contact_numbers.hpp>

#include "handle.hpp"

namespace barchan::python {
namespace {

using Ids = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
using Reals = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Three = std::array<double, 3>;

std::span<const std::int64_t> span_of(const Ids& a) {
  return {a.data(), static_cast<std::size_t>(a.size())};
}
std::span<const double> span_of(const Reals& a) {
  return {a.data(), static_cast<std::size_t>(a.size())};
}
Vec3 vector_of(const Three& v) {
  return {v[0], v[1], v[2]};
}
Three three_of(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

py::dict measure(Handle& h) {
  const Measures m = h.call([](Simulation& s) { return s.measure(); });
  using namespace py::literals;
  return py::dict(
      "kinetic"_a = m.kinetic.value(), "elastic"_a = m.elastic.value(),
      "gravitational"_a = m.gravitational.value(),
      "momentum"_a = Three{m.momentum[0].value(), m.momentum[1].value(), m.momentum[2].value()},
      "contacts"_a = m.contacts, "bonds"_a = m.bonds, "broken_bonds"_a = m.broken_bonds,
      "max_overlap"_a = m.max_overlap, "max_overlap_share"_a = m.max_overlap_share,
      "max_speed"_a = m.max_speed);
}

py::dict info(Handle& h) {
  using namespace py::literals;
  return h.call([](Simulation& s) {
    const py::gil_scoped_acquire lock;
    std::vector<std::string> walls, materials;
    for (const WallSpec& w : s.model().walls) walls.push_back(w.name);
    for (const Material& material : s.model().materials) materials.push_back(material.name);
    return py::dict("time"_a = s.time(), "step"_a = s.step(), "dt"_a = s.model().time.step,
                    "num_steps"_a = s.model().time.num_steps, "stage"_a = s.stage(),
                    "dimension"_a = s.model().dimension, "num_owned"_a = s.num_owned(),
                    "num_particles"_a = s.num_particles(), "num_bricks"_a = s.num_bricks(),
                    "stopped"_a = s.stopped(), "is_over"_a = s.is_over(),
                    "threads"_a = s.options().threads, "exchange"_a = s.exchange_choice().name,
                    "vector"_a = s.vector_width(), "walls"_a = walls, "materials"_a = materials,
                    "title"_a = s.model().title, "gravity"_a = three_of(s.model().gravity));
  });
}

py::dict wall(Handle& h, const std::string& name) {
  using namespace py::literals;
  Vec3 normal;
  const WallState w = h.call([&](Simulation& s) {
    normal = s.wall(name).normal();
    return s.wall(name).state();
  });
  return py::dict("point"_a = three_of(w.point), "normal"_a = three_of(normal),
                  "velocity"_a = three_of(w.velocity), "force"_a = three_of(w.force),
                  "torque"_a = three_of(w.torque), "work"_a = w.work, "is_active"_a = w.is_active);
}

template <class Field>
py::object gather(Handle& h, const Field& field, int width) {
  Gathered all;
  const bool is_root = h.call([&](Simulation& s) {
    all = s.gather(field);
    return s.communicator().is_root();
  });
  if (!is_root) return py::none();
  const auto n = static_cast<py::ssize_t>(all.ids.size());
  Ids ids(n, all.ids.data());
  if (width == 1) return py::make_tuple(ids, Reals(n, all.values.data()));
  return py::make_tuple(ids, Reals({n, py::ssize_t{width}}, all.values.data()));
}

py::dict links(Handle& h, LinkKind kind) {
  const std::vector<LinkForce> all = h.call([&](Simulation& s) { return s.links(kind); });
  const auto n = static_cast<py::ssize_t>(all.size());
  py::array_t<std::int64_t> first(n), second(n);
  py::array_t<double> overlap(n), normal_force(n), normal({n, py::ssize_t{3}}),
      tangential_force({n, py::ssize_t{3}});
  for (py::ssize_t i = 0; i < n; ++i) {
    const LinkForce& link = all[static_cast<std::size_t>(i)];
    first.mutable_at(i) = link.first;
    second.mutable_at(i) = link.second;
    overlap.mutable_at(i) = link.overlap;
    normal_force.mutable_at(i) = link.normal_force;
    for (int c = 0; c < 3; ++c) {
      normal.mutable_at(i, c) = link.normal[c];
      tangential_force.mutable_at(i, c) = link.tangential_force[c];
    }
  }
  using namespace py::literals;
  return py::dict("first"_a = first, "second"_a = second, "normals"_a = normal,
                  "overlaps"_a = overlap, "normal_forces"_a = normal_force,
                  "tangential_forces"_a = tangential_force);
}

/// Columns of one length each; the package has seen to that.
std::vector<ParticleData> newcomers(const Ids& ids, const Ids& types, const Reals& radii,
                                    const Reals& densities, const Reals& motion) {
  std::vector<ParticleData> particles(static_cast<std::size_t>(ids.size()));
  const double* at = motion.data();
  for (py::ssize_t i = 0; i < ids.size(); ++i, at += 9) {
    ParticleData& p = particles[static_cast<std::size_t>(i)];
    p.id = ids.at(i);
    p.type = static_cast<std::int32_t>(types.at(i));
    p.radius = radii.at(i);
    p.density = densities.at(i);
    p.position = Vec3(at[0], at[1], at[2]);
    p.velocity = Vec3(at[3], at[4], at[5]);
    p.omega = Vec3(at[6], at[7], at[8]);
  }
  return particles;
}

void define_views(py::module_& m) {
  using B = BrickOfMoment;
  py::class_<B>(m, "Brick")
      .def("__len__", [](const B& b) { return b.view().size(); })
      .def_property_readonly(
          "ids",
          [](const B& b) {
            const auto ids = b.view().ids();
            return b.array(StridedSpan<const std::int64_t>(ids.data(), ids.size(), 1, 1));
          })
      .def_property_readonly(
          "types",
          [](const B& b) {
            const auto types = b.view().types();
            return b.array(StridedSpan<const std::uint8_t>(types.data(), types.size(), 1, 1));
          })
      .def_property_readonly("densities",
                             [](const B& b) {
                               const auto d = b.view().densities();
                               return b.array(StridedSpan<const double>(d.data(), d.size(), 1, 1));
                             })
      .def_property_readonly("positions", [](const B& b) { return b.array(b.view().positions()); })
      .def_property_readonly("velocities",
                             [](const B& b) { return b.array(b.view().velocities()); })
      .def_property_readonly("surface_speeds",
                             [](const B& b) { return b.array(b.view().surface_speeds()); })
      .def_property_readonly("radii", [](const B& b) { return b.array(b.view().radii()); })
      .def_property_readonly("inverse_masses",
                             [](const B& b) { return b.array(b.view().inverse_masses()); })
      .def("field",
           [](const B& b, const std::string& name) { return b.writeable_array(b.field(name)); })
      .def_property_readonly("forces",
                             [](const B& b) { return b.writeable_array(b.loads().forces()); })
      .def_property_readonly("torques_by_radius", [](const B& b) {
        return b.writeable_array(b.loads().torques_by_radius());
      });
}

void define_simulation(py::module_& m) {
  using S = Simulation;
  py::class_<Handle> simulation(m, "Simulation");
  define_events(simulation);
  simulation.def("info", &info)
      .def("owned", &Handle::owned)
      .def("close", &Handle::close)
      .def("measure", &measure)
      .def("wall", &wall)
      .def("gather",
           [](Handle& h, ParticleField field) { return gather(h, field, width_of(field)); })
      .def("gather_field", &gather<std::string>)
      .def("add_field",
           [](Handle& h, const std::string& name, int components) {
             return h.change([&](S& s) { return s.add_field(name, components); });
           })
      .def("fields",
           [](Handle& h) {
             std::map<std::string, int> components;
             for (const CallerField& field : h.call([](S& s) { return s.fields(); }))
               components[field.name] = field.components;
             return components;
           })
      .def("scatter_field",
           [](Handle& h, const std::string& name, const Ids& ids, const Reals& values) {
             h.call([&](S& s) { s.scatter(name, span_of(ids), span_of(values)); });
           })
      .def("links", &links)
      .def("set_time_step",
           [](Handle& h, double dt) { h.change([&](S& s) { s.set_time_step(dt); }); })
      .def("run",
           [](Handle& h, std::int64_t n) { return h.change([&](S& s) { return s.run(n); }); })
      .def("advance_to",
           [](Handle& h, double t) { return h.change([&](S& s) { return s.advance_to(t); }); })
      .def("digest", [](Handle& h) { return h.call([](S& s) { return s.digest(); }); })
      .def("highest_id", [](Handle& h) { return h.call([](S& s) { return s.highest_id(); }); })
      .def("set_loads",
           [](Handle& h, const Ids& ids, const Reals& forces, const Reals& torques) {
             h.call([&](S& s) { s.set_loads({span_of(ids), span_of(forces), span_of(torques)}); });
           })
      .def("clear_loads", [](Handle& h) { h.change([](S& s) { s.clear_forces(); }); })
      .def("scatter",
           [](Handle& h, ParticleField field, const Ids& ids, const Reals& values) {
             h.change([&](S& s) { s.scatter(field, span_of(ids), span_of(values)); });
           })
      .def("add",
           [](Handle& h, const Ids& ids, const Ids& types, const Reals& radii,
              const Reals& densities, const Reals& motion) {
             const auto particles = newcomers(ids, types, radii, densities, motion);
             h.change([&](S& s) { s.add(particles); });
           })
      .def("material_density",
           [](Handle& h, std::size_t type) {
             return h.call([&](S& s) { return s.model().materials.at(type).density; });
           })
      .def("remove",
           [](Handle& h, const Ids& ids) { h.change([&](S& s) { s.remove(span_of(ids)); }); })
      .def("set_gravity",
           [](Handle& h, const Three& g) { h.change([&](S& s) { s.set_gravity(vector_of(g)); }); })
      .def("set_contact",
           [](Handle& h, const std::string& a, const std::string& b,
              const std::map<std::string, double>& numbers) {
             h.call([&](S& s) {
               ContactConstants pair = s.contact(a, b);
               for (const auto& [key, value] : numbers)
                 set_number(s.model().contacts, pair, key, value);
               s.set_contact(a, b, pair);
             });
           })
      .def("set_wall_velocity",
           [](Handle& h, const std::string& name, const Three& v) {
             h.change([&](S& s) { s.wall(name).set_velocity(vector_of(v)); });
           })
      .def("set_wall_load", [](Handle& h, const std::string& name,
                               double load) { h.call([&](S& s) { s.wall(name).set_load(load); }); })
      .def("set_wall_pose",
           [](Handle& h, const std::string& name, const Three& point, const Three& normal) {
             h.change([&](S& s) { s.wall(name).set_pose(vector_of(point), vector_of(normal)); });
           })
      .def("save", [](Handle& h, State& state) { h.call([&](S& s) { s.save(state); }); })
      .def("load", [](Handle& h, const State& state) { h.change([&](S& s) { s.load(state); }); })
      .def("write_checkpoint",
           [](Handle& h, const std::string& folder) {
             return h.call([&](S& s) {
               s.keep_checkpoints(folder, s.model().checkpoint);
               s.save_checkpoint();
               return s.finish_checkpoints();
             });
           })
      .def("keep_checkpoints",
           [](Handle& h, const std::string& folder, std::int64_t every_steps, double every_seconds,
              int keep) {
             h.call([&](S& s) { s.keep_checkpoints(folder, {every_steps, every_seconds, keep}); });
           })
      .def("take_notes", [](Handle& h) {
        std::vector<std::string> texts;
        for (const Note& note : h.call([](S& s) { return s.take_notes(); }))
          texts.push_back(note.text);
        return texts;
      });
}

}  // namespace

void define_calls(py::module_& m) {
  using F = ParticleField;
  py::enum_<F>(m, "Field")
      .value("position", F::Position)
      .value("velocity", F::Velocity)
      .value("angular_velocity", F::AngularVelocity)
      .value("force", F::Force)
      .value("torque", F::Torque)
      .value("radius", F::Radius)
      .value("mass", F::Mass)
      .value("type", F::Type)
      .value("temperature", F::Temperature);
  py::enum_<LinkKind>(m, "LinkKind")
      .value("contacts", LinkKind::Contacts)
      .value("wall_contacts", LinkKind::WallContacts)
      .value("bonds", LinkKind::Bonds);
  py::class_<State>(m, "State")
      .def(py::init<>())
      .def_property_readonly("step", &State::step)
      .def_property_readonly("bytes", &State::bytes);
  define_views(m);
  define_simulation(m);
}

}  // namespace barchan::python

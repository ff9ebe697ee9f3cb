#include <barchan/tasks/results/series_table.hpp>

#include <array>
#include <cctype>
#include <set>

#include <barchan/tasks/agree.hpp>

namespace barchan {
namespace {

constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};

bool moves(const WallSpec& wall) {
  return wall.is_loaded || !wall.velocity.isZero();
}

std::vector<std::string> columns_of(const Model& model, const std::vector<Ring>& rings) {
  std::vector<std::string> columns{"elastic_energy", "gravitational_energy"};
  const auto add_vector = [&](const std::string& name) {
    for (int c = 0; c < model.dimension; ++c)
      columns.push_back(name + "_" + kAxes[static_cast<std::size_t>(c)]);
  };
  add_vector("momentum");
  for (const char* name : {"bonds", "broken_bonds", "max_speed", "stage", "particles"})
    columns.emplace_back(name);
  const std::vector<std::string> names = wall_columns(model.walls);
  for (std::size_t w = 0; w < model.walls.size(); ++w) {
    add_vector(names[w] + "_force");
    if (moves(model.walls[w])) add_vector(names[w] + "_position");
  }
  for (const Ring& ring : rings) {
    columns.push_back(ring.name + "_diameter_x");
    columns.push_back(ring.name + "_diameter_y");
  }
  if (model.heat.is_on) {
    columns.insert(columns.end(),
                   {"heat", "mean_temperature", "min_temperature", "max_temperature"});
    for (std::size_t w = 0; w < model.walls.size(); ++w) {
      if (model.walls[w].gives_heat()) columns.push_back(names[w] + "_heat_flow");
    }
  }
  if (model.output.energy) {
    columns.insert(columns.end(), {"wall_work", "gravity_work", "caller_work", "contact_loss",
                                   "dashpot_loss", "sliding_loss", "rolling_loss", "bond_loss",
                                   "damping_loss", "departed_energy", "energy_error"});
  }
  return columns;
}

using Cells = std::vector<std::optional<double>>;

Cells values_of(const Simulation& simulation, const Measures& m, const Cells& diameters) {
  const Model& model = simulation.model();
  Cells values{m.elastic.value(), m.gravitational.value()};
  for (int c = 0; c < model.dimension; ++c) values.emplace_back(m.momentum[c].value());
  values.insert(values.end(), {static_cast<double>(m.bonds), static_cast<double>(m.broken_bonds),
                               m.max_speed, static_cast<double>(simulation.stage() + 1),
                               static_cast<double>(simulation.num_particles())});
  const auto walls = simulation.walls();
  for (std::size_t w = 0; w < walls.size(); ++w) {
    for (int c = 0; c < model.dimension; ++c) values.emplace_back(walls[w].force[c]);
    if (!moves(model.walls[w])) continue;
    for (int c = 0; c < model.dimension; ++c) values.emplace_back(walls[w].point[c]);
  }
  values.insert(values.end(), diameters.begin(), diameters.end());
  if (model.heat.is_on) {
    values.insert(values.end(),
                  {m.heat.value(), m.mean_temperature(), m.min_temperature, m.max_temperature});
    for (std::size_t w = 0; w < walls.size(); ++w) {
      if (model.walls[w].gives_heat()) values.emplace_back(walls[w].heat_flow);
    }
  }
  if (model.output.energy) {
    const EnergyBudget b = simulation.energy_budget(m);
    values.insert(values.end(), {b.wall_work, b.gravity_work, b.caller_work, b.contact_loss,
                                 b.dashpot_loss, b.sliding_loss, b.rolling_loss, b.bond_loss,
                                 b.damping_loss, b.departed, b.error});
  }
  return values;
}

}  // namespace

std::string column_name(const std::string& name) {
  std::string column = name;
  for (char& c : column) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-';
    if (!is_plain) c = '_';
  }
  return column;
}

std::vector<std::string> wall_columns(std::span<const WallSpec> walls) {
  std::vector<std::string> columns;
  std::set<std::string> taken;
  for (const WallSpec& wall : walls) {
    columns.push_back(column_name(wall.name));
    if (columns.back() == wall.name) taken.insert(wall.name);
  }
  for (std::size_t w = 0; w < walls.size(); ++w) {
    if (columns[w] == walls[w].name) continue;
    const std::string stem = columns[w];
    for (int number = 2; !taken.insert(columns[w]).second; ++number)
      columns[w] = stem + "_" + std::to_string(number);
  }
  return columns;
}

SeriesTable::SeriesTable(const Simulation& simulation, const std::string& path,
                         std::vector<Ring> rings, bool continues)
    : rings_(std::move(rings)) {
  agree(simulation.communicator(), [&] {
    if (!simulation.communicator().is_root()) return;
    const auto columns = columns_of(simulation.model(), rings_);
    writer_.emplace(continues ? SeriesWriter::resume(path, columns, simulation.step() - 1)
                              : SeriesWriter::create(path, columns));
  });
}

std::string SeriesTable::damage(const Simulation& simulation, std::int64_t interval) const {
  return writer_ ? writer_->damage(simulation.step(), interval) : "";
}

Measures SeriesTable::append(Simulation& simulation) {
  const Measures m = simulation.measure();
  const Cells diameters = ring_diameters(simulation, rings_);
  agree(simulation.communicator(), [&] {
    if (!writer_) return;
    writer_->append(
        {simulation.step(), simulation.time(), m.kinetic.value(), m.contacts, m.max_overlap},
        values_of(simulation, m, diameters));
  });
  return m;
}

}  // namespace barchan

#include <barchan/tasks/results/snapshots.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include <barchan/tasks/results/agree.hpp>
#include <barchan/tasks/results/own_files.hpp>

namespace barchan {
namespace {

/// The particles of one rank, column by column.
struct Columns {
  std::vector<double> points, radius, density, velocity, omega;
  std::vector<std::int64_t> id;
  std::vector<std::int32_t> type, rank;

  Columns(const Simulation& simulation, const Densities& densities) {
    rank.assign(static_cast<std::size_t>(simulation.num_owned()), simulation.communicator().rank());
    simulation.for_each_owned([&](const OwnedParticle& p) {
      id.push_back(p.id);
      type.push_back(p.type + 1);
      radius.push_back(p.radius);
      density.push_back(densities.of(p.id, p.type));
      for (int c = 0; c < 3; ++c) {
        points.push_back(p.position[c]);
        velocity.push_back(p.velocity[c]);
        omega.push_back(p.omega[c]);
      }
    });
  }

  [[nodiscard]] VtpArrays arrays(const Simulation& simulation) const {
    using Reals = std::span<const double>;
    using Ints = std::span<const std::int32_t>;
    VtpArrays arrays{simulation.step(), simulation.time(), points, {}};
    arrays.fields = {{"id", 1, std::span<const std::int64_t>(id)},
                     {"type", 1, Ints(type)},
                     {"radius", 1, Reals(radius)},
                     {"density", 1, Reals(density)},
                     {"velocity", 3, Reals(velocity)},
                     {"angular_velocity", 3, Reals(omega)},
                     {"rank", 1, Ints(rank)}};
    return arrays;
  }
};

std::string piece_name(std::int64_t step, int rank) {
  return fmt::format("step_{:09}_rank_{}.vtp", step, rank);
}

}  // namespace

Densities::Densities(const Model& model, const ParticleSet& particles) {
  for (const Material& material : model.materials) of_material_.push_back(material.density);
  for (const ParticleData& p : particles.particles) {
    if (p.density != of_material_[static_cast<std::size_t>(p.type)])
      others_.emplace_back(p.id, p.density);
  }
  std::sort(others_.begin(), others_.end());
}

double Densities::of(std::int64_t id, std::int32_t type) const {
  const auto it =
      std::lower_bound(others_.begin(), others_.end(), id,
                       [](const auto& entry, std::int64_t wanted) { return entry.first < wanted; });
  if (it != others_.end() && it->first == id) return it->second;
  return of_material_[static_cast<std::size_t>(type)];
}

void SnapshotWriter::resume(const Simulation& simulation, std::int64_t every) {
  namespace fs = std::filesystem;
  agree(simulation.communicator(), [&] {
    if (!simulation.communicator().is_root()) return;
    std::vector<fs::path> obsolete;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      const std::optional<std::int64_t> found = snapshot_step(name);
      if (!found) continue;
      const std::int64_t step = *found;
      const bool stays = step < simulation.step() && step % every == 0;
      if (!stays)
        obsolete.push_back(entry.path());
      else if (name.ends_with(".pvtp"))
        entries_.push_back({static_cast<double>(step) * simulation.model().time.step, name});
    }
    for (const fs::path& path : obsolete) fs::remove(path);
    std::sort(entries_.begin(), entries_.end(),
              [](const PvdEntry& a, const PvdEntry& b) { return a.time < b.time; });
  });
}

void SnapshotWriter::write(const Simulation& simulation) {
  const Communicator& communicator = simulation.communicator();
  const std::int64_t step = simulation.step();
  const Columns columns(simulation, densities_);
  const VtpArrays arrays = columns.arrays(simulation);
  agree(communicator,
        [&] { write_vtp(folder_ + "/" + piece_name(step, communicator.rank()), arrays); });
  agree(communicator, [&] {
    if (!communicator.is_root()) return;
    std::vector<std::string> pieces;
    for (int rank = 0; rank < communicator.size(); ++rank) pieces.push_back(piece_name(step, rank));
    const std::string whole = fmt::format("step_{:09}.pvtp", step);
    write_pvtp(folder_ + "/" + whole, pieces, arrays);
    entries_.push_back({simulation.time(), whole});
    write_pvd(folder_ + "/run.pvd", entries_);
  });
  last_step_ = step;
}

}  // namespace barchan

#include <barchan/tasks/results/snapshots.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include <barchan/core/io/bond_lines.hpp>
#include <barchan/core/io/particle_columns.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/results/own_files.hpp>

namespace barchan {
namespace {

std::string piece_name(std::int64_t step, int rank) {
  return fmt::format("step_{:09}_rank_{}.vtp", step, rank);
}

std::string whole_name(std::int64_t step) {
  return fmt::format("step_{:09}.pvtp", step);
}

}  // namespace

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
        entries_.push_back({static_cast<double>(step) * simulation.model().time.step, name,
                            name == whole_name(step) ? 0 : 1});
    }
    for (const fs::path& path : obsolete) fs::remove(path);
    std::sort(entries_.begin(), entries_.end(), [](const PvdEntry& a, const PvdEntry& b) {
      return a.time != b.time ? a.time < b.time : a.part < b.part;
    });
  });
}

void SnapshotWriter::write(Simulation& simulation) {
  const std::int64_t step = simulation.step();
  const std::string name = folder_ + "/" + piece_name(step, simulation.communicator().rank());
  ParticleArrays particles(simulation.model().heat.is_on);
  simulation.for_each_owned([&](const OwnedParticle& p) { particles.add(p); });
  const std::vector<std::int32_t> rank(static_cast<std::size_t>(simulation.num_owned()),
                                       simulation.communicator().rank());
  VtpArrays arrays = particles.arrays(step, simulation.time());
  arrays.fields.push_back({"rank", 1, std::span<const std::int32_t>(rank)});
  agree(simulation.communicator(), [&] { write_vtp(name, arrays); });
  write_whole(whole_name(step), arrays, simulation);
  if (!simulation.model().bond_laws.empty()) write_bonds(simulation);
  agree(simulation.communicator(), [&] {
    if (simulation.communicator().is_root()) write_pvd(folder_ + "/run.pvd", entries_);
  });
  last_step_ = step;
}

void SnapshotWriter::write_bonds(Simulation& simulation) {
  const std::int64_t step = simulation.step();
  const std::string name = folder_ + "/" + piece_name(step, simulation.communicator().rank());
  BondLines lines;
  simulation.for_each_bond(
      [&](const BondData& bond, const Vec3& a, const Vec3& b) { lines.add(bond, a, b); });
  const VtpArrays arrays = lines.arrays(step, simulation.time());
  agree(simulation.communicator(), [&] { write_vtp(bonds_path(name), arrays); });
  write_whole(bonds_path(whole_name(step)), arrays, simulation);
}

/// Names the pieces of all ranks, on rank 0.
void SnapshotWriter::write_whole(const std::string& name, const VtpArrays& arrays,
                                 const Simulation& simulation) {
  agree(simulation.communicator(), [&] {
    if (!simulation.communicator().is_root()) return;
    std::vector<std::string> pieces;
    for (int rank = 0; rank < simulation.communicator().size(); ++rank) {
      const std::string piece = piece_name(simulation.step(), rank);
      pieces.push_back(arrays.are_lines ? bonds_path(piece) : piece);
    }
    write_pvtp(folder_ + "/" + name, pieces, arrays);
    entries_.push_back({simulation.time(), name, arrays.are_lines ? 1 : 0});
  });
}

}  // namespace barchan

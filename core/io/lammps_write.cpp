#include <algorithm>

#include <fmt/format.h>

#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/text_file.hpp>

namespace barchan {
namespace {

void write_header(OutputFile& file, std::span<const ParticleData> particles,
                  std::span<const BondData> bonds, const LammpsSpec& spec) {
  std::int32_t last_type = 0, last_law = 0;
  double thickest = 0.0;
  for (const ParticleData& p : particles) {
    last_type = std::max(last_type, p.type);
    thickest = std::max(thickest, p.radius);
  }
  for (const BondData& bond : bonds) last_law = std::max(last_law, bond.law);
  const Box& box = spec.box;
  const double z_lo = spec.dimension == 2 ? -2.0 * thickest : box.lo.z();
  const double z_hi = spec.dimension == 2 ? 2.0 * thickest : box.hi.z();
  file.write(fmt::format("Particles written by barchan\n\n{} atoms\n{} atom types\n",
                         particles.size(), last_type + 1));
  if (spec.has_bonds)
    file.write(fmt::format("{} bonds\n{} bond types\n", bonds.size(), last_law + 1));
  file.write(fmt::format("\n{:.17g} {:.17g} xlo xhi\n", box.lo.x(), box.hi.x()));
  file.write(fmt::format("{:.17g} {:.17g} ylo yhi\n", box.lo.y(), box.hi.y()));
  file.write(fmt::format("{:.17g} {:.17g} zlo zhi\n", z_lo, z_hi));
}

void write_atoms(OutputFile& file, std::span<const ParticleData> particles,
                 const LammpsSpec& spec) {
  const bool is_other_density = spec.dimension == 2 && spec.has_sphere_density;
  file.write(spec.has_bonds ? "\nAtoms # bpm/sphere\n\n" : "\nAtoms # sphere\n\n");
  for (const ParticleData& p : particles) {
    const double density = is_other_density ? p.density / (4.0 / 3.0 * p.radius) : p.density;
    file.write(fmt::format("{} {}{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", p.id,
                           spec.has_bonds ? "1 " : "", p.type + 1, 2.0 * p.radius, density,
                           p.position.x(), p.position.y(), p.position.z()));
  }
}

void write_bonds(OutputFile& file, std::span<const BondData> bonds) {
  if (bonds.empty()) return;
  file.write("\nBonds\n\n");
  std::size_t number = 0;
  for (const BondData& b : bonds) {
    file.write(fmt::format("{} {} {} {} # length {:.17g} shear {:.17g} {:.17g} {:.17g}", ++number,
                           b.law + 1, b.id_a, b.id_b, b.length, b.shear.x(), b.shear.y(),
                           b.shear.z()));
    file.write(fmt::format(" bending {:.17g} {:.17g} {:.17g} twisting {:.17g}\n", b.bending.x(),
                           b.bending.y(), b.bending.z(), b.twisting));
  }
}

}  // namespace

void write_particles_lammps(const std::string& path, std::span<const ParticleData> particles,
                            std::span<const BondData> bonds, const LammpsSpec& spec) {
  OutputFile file(path);
  write_header(file, particles, bonds, spec);
  write_atoms(file, particles, spec);
  file.write("\nVelocities\n\n");
  for (const ParticleData& p : particles) {
    file.write(fmt::format("{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", p.id,
                           p.velocity.x(), p.velocity.y(), p.velocity.z(), p.omega.x(), p.omega.y(),
                           p.omega.z()));
  }
  write_bonds(file, bonds);
  file.commit();
}

}  // namespace barchan

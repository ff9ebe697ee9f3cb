// Embeds barchan in a program of its own: spheres sink in a viscous fluid until drag and weight
// balance.
//
// The caller owns MPI, gives barchan a communicator of its choice, steps it in a loop, reads
// velocities and adds a force to every particle. Here the force is Stokes' drag, so the result is
// known: v = (rho_s − rho_f) g d² / (18 eta).
#include <mpi.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <numbers>

#include <barchan/core/base/error.hpp>
#include <barchan/tasks/simulation.hpp>

namespace {

constexpr double kRadius = 0.5e-3;       // [m]
constexpr double kDensity = 2500.0;      // of the spheres [kg/m³]
constexpr double kFluidDensity = 970.0;  // silicone oil
constexpr double kViscosity = 0.05;      // [Pa·s]
constexpr double kGravity = 9.81;        // [m/s²]
constexpr double kStep = 2e-5;           // [s]
constexpr int kStepsPerCall = 10;        // the drag is set anew this often

/// Spheres in a tall box, periodic sideways, so far apart that each sinks alone.
barchan::Model make_model() {
  barchan::Model model;
  model.dimension = 3;
  model.domain.hi = barchan::Vec3(0.08, 0.02, 0.02);
  model.domain.periodic = {true, true, false};
  model.time.step = kStep;
  model.gravity = barchan::Vec3(0.0, 0.0, -kGravity);
  model.materials = {{"glass", kDensity}};
  barchan::ContactConstants contact;
  contact.kn = 10.0;
  contact.kt = 5.0;
  contact.mu = 0.3;
  model.contacts.num_materials = 1;
  model.contacts.constants = {contact};
  model.stages = {barchan::Stage{}};
  return model;
}

/// The same on every rank; barchan keeps each rank's share.
barchan::ParticleSet make_spheres() {
  barchan::ParticleSet set;
  for (int i = 0; i < 16; ++i) {
    for (int j = 0; j < 4; ++j) {
      barchan::ParticleData p;
      p.id = static_cast<std::int64_t>(set.particles.size()) + 1;
      p.radius = kRadius;
      p.density = kDensity;
      p.position =
          barchan::Vec3(0.005 * (i + 0.5), 0.005 * (j + 0.5), 0.01 + 0.001 * ((i + j) % 3));
      p.velocity[0] = 0.05;  // a drift that drag takes away
      set.particles.push_back(p);
    }
  }
  return set;
}

/// Drag and buoyancy on one sphere.
barchan::Vec3 force_of_fluid(const barchan::OwnedParticle& p) {
  const double drag = 6.0 * std::numbers::pi * kViscosity * p.radius;
  const double displaced = p.mass * kFluidDensity / kDensity;
  return barchan::Vec3(-drag * p.velocity + barchan::Vec3(0.0, 0.0, displaced * kGravity));
}

/// Mean velocity over all ranks. Collective.
barchan::Vec3 mean_velocity(const barchan::Simulation& simulation) {
  double sum[3] = {};
  simulation.for_each_owned([&](const barchan::OwnedParticle& p) {
    for (int c = 0; c < 3; ++c) sum[c] += p.velocity[c];
  });
  MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPI_DOUBLE, MPI_SUM, simulation.communicator().handle());
  const auto n = static_cast<double>(simulation.num_particles());
  return {sum[0] / n, sum[1] / n, sum[2] / n};
}

/// @return whether the spheres sink as fast as theory says, the same on every rank of
/// `communicator`
bool sink(MPI_Comm communicator, bool prints) {
  barchan::Simulation simulation(make_model(), make_spheres(), communicator);
  const double mass = kDensity * 4.0 / 3.0 * std::numbers::pi * std::pow(kRadius, 3);
  const double relaxation = mass / (6.0 * std::numbers::pi * kViscosity * kRadius);  // [s]
  while (simulation.time() < 20.0 * relaxation) {
    simulation.apply_forces(force_of_fluid);
    simulation.run(kStepsPerCall);
  }
  const barchan::Vec3 velocity = mean_velocity(simulation);
  const double expected =
      -2.0 / 9.0 * (kDensity - kFluidDensity) * kGravity * kRadius * kRadius / kViscosity;
  const double error = std::fabs(velocity[2] / expected - 1.0);
  if (prints) {
    std::printf(
        "%lld spheres, %lld steps: they sink at %.6g mm/s, theory says %.6g mm/s (off by %.2g "
        "%%)\n",
        static_cast<long long>(simulation.num_particles()),
        static_cast<long long>(simulation.step()), 1e3 * velocity[2], 1e3 * expected,
        100.0 * error);
  }
  return error < 1e-3 && std::fabs(velocity[0]) < 1e-3 * std::fabs(expected);
}

}  // namespace

int main(int argc, char** argv) {
  // barchan calls MPI from one thread at a time, whichever it is.
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  int rank = 0;
  int size = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);

  // A communicator of its own: half of the ranks, as if the others solved for the fluid.
  const bool is_solid = rank < (size + 1) / 2;
  MPI_Comm solid = MPI_COMM_NULL;
  MPI_Comm_split(MPI_COMM_WORLD, is_solid ? 0 : MPI_UNDEFINED, rank, &solid);
  int failed = 0;
  if (is_solid) {
    try {
      failed = sink(solid, rank == 0) ? 0 : 1;
    } catch (const barchan::InputError& error) {  // the same on every rank: say it once
      if (rank == 0) std::fprintf(stderr, "embed: %s\n", error.what());
      failed = 1;
    } catch (const std::exception& error) {  // perhaps on this rank only, while others wait for it
      std::fprintf(stderr, "embed: rank %d: %s\n", rank, error.what());
      MPI_Abort(MPI_COMM_WORLD, 1);
    }
    MPI_Comm_free(&solid);
  }
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  if (failed != 0 && rank == 0) std::fputs("embed: not the velocity that theory gives\n", stderr);
  MPI_Finalize();
  return failed;
}

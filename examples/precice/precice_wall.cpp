// An adapter for preCICE 3: another solver moves a wall, and gets the force of the particles on it.
//
//     mpirun -n 2 precice_wall wall.toml lid precice-config.xml
//
// The mesh "Wall-Mesh" has one vertex, the point of the wall, on rank 0. Read: "Displacement" of
// the wall [m]; within a window the wall goes there at a constant velocity. Written: "Force" of the
// particles on the wall [N]. Explicit and implicit schemes, windows of any length.
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <precice/precice.hpp>

#include <barchan/tasks/open_deck.hpp>

namespace {

constexpr const char* kMesh = "Wall-Mesh";

/// The wall as the partner sees it: its vertex and data, on rank 0; others follow.
class Partner {
 public:
  Partner(precice::Participant& participant, const barchan::Vec3& point, bool is_root)
      : participant_(participant), is_root_(is_root) {
    const int dim = participant.getMeshDimensions(kMesh);
    const std::vector<double> at(point.data(), point.data() + dim);
    values_.assign(static_cast<std::size_t>(dim), 0.0);
    vertices_.resize(is_root ? 1 : 0);
    if (is_root) participant.setMeshVertices(kMesh, at, vertices_);
  }
  /// Where the wall shall be after so long [m]. Collective.
  barchan::Vec3 displacement(double later) {
    if (is_root_) participant_.readData(kMesh, "Displacement", vertices_, later, values_);
    barchan::Vec3 where = barchan::Vec3::Zero();
    std::copy(values_.begin(), values_.end(), where.data());
    MPI_Bcast(where.data(), 3, MPI_DOUBLE, 0, MPI_COMM_WORLD);
    return where;
  }
  void tell(const barchan::Vec3& force) {
    if (!is_root_) return;
    std::copy_n(force.data(), values_.size(), values_.begin());
    participant_.writeData(kMesh, "Force", vertices_, values_);
  }

 private:
  precice::Participant& participant_;
  bool is_root_;
  std::vector<precice::VertexID> vertices_;
  std::vector<double> values_;
};

void couple(barchan::Simulation& sim, const std::string& wall, precice::Participant& participant) {
  barchan::WallControl control = sim.wall(wall);
  const barchan::Vec3 start = control.state().point;
  Partner partner(participant, start, sim.communicator().is_root());
  participant.initialize();
  barchan::State before;
  while (participant.isCouplingOngoing()) {
    if (participant.requiresWritingCheckpoint()) sim.save(before);
    const double dt = participant.getMaxTimeStepSize();
    const barchan::Vec3 target = start + partner.displacement(dt);
    control.set_velocity((target - control.state().point) / dt);
    sim.advance_to(sim.time() + dt);  // with a shorter last step where the window needs one
    (void)sim.measure();              // now the wall knows its force
    partner.tell(control.state().force);
    participant.advance(dt);
    if (participant.requiresReadingCheckpoint()) sim.load(before);
  }
  participant.finalize();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: precice_wall DECK WALL CONFIG\n");
    return 2;
  }
  int level = 0, rank = 0, size = 1;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &level);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  try {
    barchan::Simulation sim = barchan::open_deck({argv[1], "", {}}, MPI_COMM_WORLD);
    precice::Participant participant("Particles", argv[3], rank, size);
    couple(sim, argv[2], participant);
    const barchan::WallState& wall = sim.wall(argv[2]).state();
    if (rank == 0)
      std::printf("at %.6g s the particles push the wall by %.6g N\n", sim.time(),
                  wall.force.norm());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "precice_wall: rank %d: %s\n", rank, e.what());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  MPI_Finalize();
  return 0;
}

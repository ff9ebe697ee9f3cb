#include <barchan/comm/base/launcher.hpp>

#include <array>
#include <cstdlib>

#include <barchan/comm/base/mpi_session.hpp>

namespace barchan {
namespace {

struct Launcher {
  const char *size, *rank;
};

/// Open MPI and PRRTE, MPICH and Intel MPI and Cray, MVAPICH, IBM's jsrun, Flux, srun.
constexpr std::array<Launcher, 6> kLaunchers{{{"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"},
                                              {"PMI_SIZE", "PMI_RANK"},
                                              {"MV2_COMM_WORLD_SIZE", "MV2_COMM_WORLD_RANK"},
                                              {"JSM_NAMESPACE_SIZE", "JSM_NAMESPACE_RANK"},
                                              {"FLUX_JOB_SIZE", "FLUX_TASK_RANK"},
                                              {"SLURM_STEP_NUM_TASKS", "SLURM_PROCID"}}};

long number(const char* variable) {
  const char* text = std::getenv(variable);
  return text == nullptr ? 0 : std::strtol(text, nullptr, 10);
}

/// A batch script has SLURM_NTASKS too, and may well start a single process without srun; but its
/// own number is 0.
long tasks_of_slurm() {
  const bool is_task = number("SLURM_PROCID") > 0 || std::getenv("SLURM_STEP_ID") != nullptr;
  return is_task ? number("SLURM_NTASKS") : 0;
}

LauncherMismatch mismatch(const std::string& variable, long size, long rank) {
  return {"a launcher started " + std::to_string(size) + " processes (" + variable +
              "), and each takes itself for the only one: the launcher is not of the MPI library "
              "of this program, which is " +
              mpi_library_version(),
          "start the program with mpirun of that library, or with srun --mpi=pmix; to run one "
          "process alone, unset " +
              variable,
          rank == 0};
}

}  // namespace

/// Where MPI has found several ranks it knows its launcher. Where one of several launchers, one in
/// the other, speaks of one process, that is the inner one.
LauncherMismatch launcher_mismatch(int world_size) {
  if (world_size > 1) return {};
  const Launcher* found = nullptr;
  for (const Launcher& launcher : kLaunchers) {
    const long size = number(launcher.size);
    if (size == 1) return {};
    if (size > 1 && found == nullptr) found = &launcher;
  }
  if (found != nullptr) return mismatch(found->size, number(found->size), number(found->rank));
  const long tasks = tasks_of_slurm();
  return tasks > 1 ? mismatch("SLURM_NTASKS", tasks, number("SLURM_PROCID")) : LauncherMismatch{};
}

}  // namespace barchan

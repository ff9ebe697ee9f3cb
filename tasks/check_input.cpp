#include <barchan/tasks/check_input.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <fmt/format.h>

#include <barchan/comm/base/thread_level.hpp>
#include <barchan/core/base/bytes.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/checkpoint/state.hpp>
#include <barchan/core/generators/check_walls.hpp>
#include <barchan/core/generators/make_particles.hpp>
#include <barchan/core/model/digest.hpp>
#include <barchan/core/model/validate.hpp>
#include <barchan/tasks/forecast.hpp>
#include <barchan/tasks/stability.hpp>
#include <barchan/tasks/threads.hpp>

namespace barchan {
namespace {

std::uint64_t hash_of(const std::string& text) {
  return hash_of_bytes(std::as_bytes(std::span(text)));
}

std::uint64_t hash_of(const Model& model) {
  std::vector<std::byte> bytes;
  ByteWriter out(bytes);
  out.put_counted(fingerprint(model));
  out.put(model.domain.outside);
  out.put(model.limits.overlap_warning);
  out.put(model.limits.overlap_error);
  out.put(model.time.allow_unstable);
  return hash_of_bytes(bytes);
}

/// Of what ranks must agree on.
std::uint64_t hash_of(const RunOptions& options) {
  return hash_of(fmt::format("{} {} {} {} {}", options.threads, options.exchange, options.trace,
                             options.tape != nullptr, options.hooks.ranks_per_node));
}

/// What a rank says when its word differs from that of rank 0.
struct Difference {
  const char* before;  ///< the rank's number
  const char* after;
};

void agree_on(const Communicator& communicator, std::array<std::uint64_t, 3> mine,
              const Difference& start) {
  if (communicator.size() == 1) return;
  const std::array<Difference, 3> differences{
      Difference{"the model of rank",
                 "differs from that of rank 0 (give every rank the same model)"},
      start,
      Difference{"the options of rank",
                 "differ from those of rank 0 (threads, exchange and trace are the same on every "
                 "rank)"}};
  std::array<std::uint64_t, 3> first = mine;
  communicator.bcast(std::as_writable_bytes(std::span(first)));
  std::string error;
  for (std::size_t p = 0; p < mine.size() && error.empty(); ++p) {
    if (mine[p] != first[p])
      error =
          fmt::format("{} {} {}", differences[p].before, communicator.rank(), differences[p].after);
  }
  error = communicator.first_error(error);
  if (!error.empty()) throw InputError(error, "");
}

bool has_several_threads(const RunOptions& options) {
  return options.threads > 1 || options.progress == Progress::Thread;
}

void check_threads(const Communicator& communicator, const RunOptions& options) {
  if (options.threads > kMostThreads)
    throw InputError(fmt::format("{} threads a rank", options.threads),
                     fmt::format("at most {}", kMostThreads));
  check_thread_level(communicator, has_several_threads(options));
}

}  // namespace

void check_input(const Communicator& communicator, const Model& model, const ParticleSet& particles,
                 const RunOptions& options) {
  agree_on(communicator, {hash_of(model), particle_set_hash(particles), hash_of(options)},
           {"the particles of rank",
            "differ from those of rank 0 (give every rank all particles, in the same order)"});
  validate(model);
  check_threads(communicator, options);
  check_particles(model, particles);
  check_walls(model, particles);
  check_time_step(model, step_limits(model, particles));
  check_precision(model, particles);
}

void check_input(const Communicator& communicator, const Model& model,
                 const std::string& checkpoint, const RunOptions& options) {
  agree_on(communicator, {hash_of(model), hash_of(checkpoint), hash_of(options)},
           {"the checkpoint's path on rank",
            "differs from that on rank 0 (give every rank the same path)"});
  validate(model);
  check_threads(communicator, options);
}

}  // namespace barchan

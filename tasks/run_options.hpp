#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <barchan/comm/base/tape.hpp>
#include <barchan/comm/slots/exchange.hpp>
#include <barchan/core/brick/departure.hpp>
#include <barchan/core/model/model.hpp>

namespace barchan {

enum class Schedule { Overlap, Sequential };
/// What moves messages while chunks run: the workers, between chunks; or a thread that does nothing
/// else, for ranks with a spare core.
enum class Progress { Poll, Thread };

/// What only tests ask for: hardships that a run must bear, and a fault that it must notice.
struct TestHooks : ExchangeHooks {  ///< tasks are delayed as messages are
  struct LossFault {
    Loss what = Loss::Nothing;  ///< the last rank loses one of these
    std::int64_t step = 0;      ///< in the first rebuild from this step on
  };
  LossFault loss;
  int rebuild_every = 0;         ///< also rebuild at multiples of it
  bool compare_shadows = false;  ///< with their owners at each rebuild; debug builds always do
};

/// How to carry out a run. No option changes a bit of the result.
struct RunOptions {
  int threads = 0;                ///< per rank; 0 = cores of the node over ranks on it
  std::string exchange = "auto";  ///< see exchange_choices()
  std::string cuts;          ///< auto, strips, or bricks such as 2,2,1; empty: as the deck says
  std::optional<int> depth;  ///< of shadows, instead of the deck's exchange.depth
  Schedule schedule = Schedule::Overlap;
  Progress progress = Progress::Poll;
  std::optional<ContactSearchKind> search;  ///< instead of the deck's
  std::string vector = "auto";              ///< scalar, avx2, avx512 or the widest possible
  bool tune_skin = true;               ///< look for the fastest skin, where the deck gives none
  bool trace = false;                  ///< record tasks and messages; see Simulation::write_trace
  std::size_t trace_events = 1 << 17;  ///< the latest events that each thread keeps
  std::optional<std::pair<std::int64_t, std::int64_t>> trace_steps;  ///< of these alone; else all
  std::shared_ptr<Tape> tape;  ///< records all messages; played by exchange "replay"
  TestHooks hooks;             ///< for tests only
};

}  // namespace barchan

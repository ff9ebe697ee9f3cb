// From a deck to a handle, and its end.
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <barchan/comm/base/fortran_handle.hpp>
#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/core/deck/deck.hpp>
#include <barchan/tasks/agree.hpp>
#include <barchan/tasks/open_deck.hpp>

#include "handle.hpp"

namespace {

using barchan::c::guarded;
using barchan::c::require;

struct Settings {
  std::vector<barchan::DeckOverride> overrides;
  barchan::RunOptions options;
};

int number_of(const std::string& key, const std::string& value) {
  std::size_t end = 0;
  int number = 0;
  try {
    number = std::stoi(value, &end);
  } catch (const std::exception&) {
    end = 0;
  }
  if (value.empty() || end != value.size() || number < 0)
    throw barchan::InputError("the setting " + key + "=" + value + " is no number",
                              "give a whole number, such as " + key + "=2");
  return number;
}

void take_option(const std::string& line, barchan::RunOptions& options) {
  const auto equal = line.find('=');
  const std::string key = line.substr(0, equal),
                    value = equal == std::string::npos ? "" : line.substr(equal + 1);
  if (key == "--threads")
    options.threads = number_of(key, value);
  else if (key == "--exchange")
    options.exchange = value;
  else if (key == "--vector")
    options.vector = value;
  else if (key == "--schedule" && (value == "overlap" || value == "sequential"))
    options.schedule =
        value == "overlap" ? barchan::Schedule::Overlap : barchan::Schedule::Sequential;
  else
    throw barchan::InputError(
        "there is no setting " + line,
        "--threads=N, --exchange=NAME, --vector=NAME, --schedule=overlap or sequential");
}

Settings settings_of(const char* text) {
  Settings settings;
  std::istringstream lines(text == nullptr ? "" : text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) continue;
    if (line.starts_with("--"))
      take_option(line, settings.options);
    else
      settings.overrides.push_back(barchan::parse_override(line));
  }
  return settings;
}

int open(barchan::DeckSource source, const char* settings, const char* checkpoint, int comm,
         barchan_sim** sim) {
  return guarded([&] {
    require(sim != nullptr, "barchan_open: nowhere to put the simulation");
    *sim = nullptr;
    barchan::Communicator ranks = barchan::communicator_of(comm);
    Settings chosen;
    barchan::agree(ranks, [&] { chosen = settings_of(settings); });
    source.overrides = std::move(chosen.overrides);
    auto handle = std::make_unique<barchan_sim>(
        barchan::open_deck(source, std::move(ranks), chosen.options, checkpoint));
    barchan::c::note(handle.get());
    *sim = handle.release();
  });
}

int refuse_null(const char* what) {
  return barchan::c::fail(BARCHAN_WRONG_CALL, std::string(what) + " is NULL");
}

}  // namespace

extern "C" {

const char* barchan_version() {
  return BARCHAN_VERSION;
}

void barchan_abi(int* major, int* minor) {
  if (major != nullptr) *major = BARCHAN_ABI_MAJOR;
  if (minor != nullptr) *minor = BARCHAN_ABI_MINOR;
}

int barchan_start_mpi() {
  return guarded([] { static const barchan::MpiSession session; });
}

int barchan_world() {
  return barchan::world_handle();
}

int barchan_open(const char* deck, const char* settings, int comm, barchan_sim** sim) {
  if (deck == nullptr) return refuse_null("barchan_open: the deck's path");
  return open({deck, "", {}}, settings, "", comm, sim);
}

int barchan_open_text(const char* toml, const char* settings, int comm, barchan_sim** sim) {
  if (toml == nullptr) return refuse_null("barchan_open_text: the text");
  return open({"", toml, {}}, settings, "", comm, sim);
}

int barchan_restore(const char* deck, const char* settings, const char* checkpoint, int comm,
                    barchan_sim** sim) {
  if (deck == nullptr) return refuse_null("barchan_restore: the deck's path");
  if (checkpoint == nullptr) return refuse_null("barchan_restore: the checkpoint's path");
  return open({deck, "", {}}, settings, checkpoint, comm, sim);
}

int barchan_close(barchan_sim* sim) {
  const int code = barchan::c::with(sim, [](const barchan::Simulation& s) {
    require(!s.is_in_callback(), "a callback may not close its simulation");
  });
  if (code != BARCHAN_OK) return code;
  barchan::c::forget(sim);
  return guarded([&] { delete sim; });
}

}  // extern "C"

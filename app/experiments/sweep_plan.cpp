#include <barchan/app/experiments/sweep_plan.hpp>

#include <sched.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <thread>

#include <fmt/format.h>

#include <barchan/app/experiments/lab.hpp>
#include <barchan/app/experiments/programs.hpp>
#include <barchan/app/loaded_deck.hpp>
#include <barchan/comm/base/mpi_session.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/base/nearest.hpp>
#include <barchan/tasks/forecast.hpp>
#include <barchan/tasks/simulation.hpp>
#include <barchan/tasks/stability.hpp>
#include <barchan/tasks/strip_plan.hpp>

namespace barchan::app {
namespace {

int number_of(const Point& point, const char* axis) {
  return std::stoi(value_of(point, axis));
}

int usable_cores() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  if (::sched_getaffinity(0, sizeof cores, &cores) == 0) return CPU_COUNT(&cores);
  return static_cast<int>(std::thread::hardware_concurrency());
}

std::vector<std::string> words_of(const std::vector<int>& numbers) {
  std::vector<std::string> words;
  for (const int number : numbers) words.push_back(std::to_string(number));
  return words;
}

Axis axis_of_key(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw InputError(fmt::format("--vary: '{}' has no values", text),
                     "give KEY=VALUE,VALUE, such as time.step=1e-4,2e-4");
  return {text.substr(0, equals), split(text.substr(equals + 1), ',')};
}

void check_exchange_word(const std::string& name) {
  const std::vector<std::string> known = exchange_choices();
  const std::vector<std::string_view> views(known.begin(), known.end());
  for (const std::string& part : split(name, '+')) {
    if (std::find(known.begin(), known.end(), part) == known.end())
      throw InputError(fmt::format("there is no exchange '{}'", part), deck::suggest(part, views));
  }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// What Open MPI, MPICH and their kin take, with a core for every thread where there are enough.
std::vector<std::string> usual_launcher(int ranks, bool is_pinned, bool is_crowded) {
  const std::string library = mpi_library_version();
  if (library.find("Open MPI") == std::string::npos) {
    const bool is_mpich = library.find("MPICH") != std::string::npos;
    const bool has_own = is_mpich && !find_program("mpiexec.mpich").empty();
    return {has_own ? "mpiexec.mpich" : "mpiexec", "-n", std::to_string(ranks)};
  }
  std::vector<std::string> words{"mpirun", "-n", std::to_string(ranks)};
  if (is_pinned)
    words.insert(words.end(), {"--bind-to", "core", "--map-by", "core"});
  else
    words.insert(words.end(), {"--oversubscribe", "--bind-to", "none"});
  if (is_crowded) words.insert(words.end(), {"--mca", "mpi_yield_when_idle", "1"});
  return words;
}

/// A deck with what --set and a point change in it.
std::vector<std::string> settings_at(const Point& point, const SweepArguments& arguments) {
  std::vector<std::string> settings = arguments.settings;
  for (const std::string& text : arguments.vary) {
    const std::string key = text.substr(0, text.find('='));
    settings.push_back(key + "=" + value_of(point, key));
  }
  return settings;
}

}  // namespace

SweepPlan::SweepPlan(const SweepArguments& arguments) : arguments_(arguments) {
  const std::filesystem::path deck(arguments.deck);
  folder_ = arguments.out.empty() ? deck.stem().string() + ".sweep" : arguments.out;
  const bool has_lab = !arguments.lab.empty();
  const std::vector<Axis> lab = has_lab ? parse_lab(arguments.lab) : std::vector<Axis>{};
  if (has_lab) netlab_ = find_netlab();
  std::vector<std::string> ranks = words_of(arguments.ranks);
  if (ranks.empty()) ranks = has_lab ? lab.front().values : std::vector<std::string>{"2"};
  axes_ = {{"ranks", ranks},
           {"threads", words_of(arguments.threads)},
           {"exchange", arguments.exchanges},
           {"schedule", arguments.schedules}};
  if (arguments.progress != std::vector<std::string>{"poll"})
    axes_.push_back({"progress", arguments.progress});
  for (const std::string& text : arguments.vary) axes_.push_back(axis_of_key(text));
  if (!arguments.commands.empty()) axes_.push_back({"barchan", arguments.commands});
  axes_.insert(axes_.end(), lab.begin(), lab.end());
  points_ = combinations(axes_);
  // Ranks that follow from hosts: each number with its own hosts only.
  if (arguments.ranks.empty() && has_lab)
    std::erase_if(points_,
                  [](const Point& p) { return value_of(p, "ranks") != value_of(p, "hosts"); });
  for (const std::string& name : arguments.exchanges) check_exchange_word(name);
  for (const Point& point : points_) check(point);
  if (has_lab) check_lab(netlab_, points_);
  check_decks();
}

void SweepPlan::check_decks() const {
  std::map<std::vector<std::string>, std::vector<int>> decks;
  for (const Point& point : points_)
    decks[settings_at(point, arguments_)].push_back(number_of(point, "ranks"));
  for (const auto& [settings, of_ranks] : decks) {
    LoadedDeck loaded = load_deck(arguments_.deck, settings);
    if (arguments_.steps) loaded.deck.model.time.num_steps = *arguments_.steps;
    check_time_step(loaded.deck.model, step_limits(loaded.deck.model, loaded.particles));
    check_precision(loaded.deck.model, loaded.particles);
    const CutPlan plan = plan_cuts(loaded.deck.model, loaded.particles);
    const Domain& domain = loaded.deck.model.domain;
    for (const int p : of_ranks)
      (void)choose_cuts({domain.cuts, p, 1, false, domain.place}, plan.room);
  }
}

void SweepPlan::check(const Point& point) const {
  const std::string starter = launcher(point).front();
  if (find_program(starter).empty())
    throw InputError(fmt::format("there is no program '{}' to start runs", starter),
                     "install it, or name another one by --launcher");
  const std::string program = value_of(point, "barchan");
  if (!program.empty() && !is_program(program))
    throw InputError(SourcePlace{program, 0, 0}, "is no program", "give --barchan the path of one");
}

bool SweepPlan::is_crowded(const Point& point) const {
  if (!arguments_.launcher.empty()) return false;
  return number_of(point, "ranks") * number_of(point, "threads") > usable_cores();
}

std::vector<std::string> SweepPlan::launcher(const Point& point) const {
  if (!netlab_.empty()) return lab_words(netlab_, point);
  const int ranks = number_of(point, "ranks"), threads = number_of(point, "threads");
  if (arguments_.launcher.empty())
    return usual_launcher(ranks, threads == 1 && !is_crowded(point), is_crowded(point));
  const std::string text = replaced(arguments_.launcher, "{threads}", std::to_string(threads));
  const bool has_place = text.find("{ranks}") != std::string::npos;
  std::vector<std::string> words;
  for (const std::string& word : split(replaced(text, "{ranks}", std::to_string(ranks)), ' ')) {
    const bool is_quoted =
        word.size() > 1 && (word[0] == '"' || word[0] == '\'') && word.back() == word[0];
    if (!word.empty()) words.push_back(is_quoted ? word.substr(1, word.size() - 2) : word);
  }
  if (!has_place) words.insert(words.end(), {"-n", std::to_string(ranks)});
  return words;
}

std::vector<std::string> SweepPlan::words(const Point& point, const std::string& out) const {
  std::vector<std::string> words = launcher(point);
  const std::string program = value_of(point, "barchan");
  words.insert(words.end(), {program.empty() ? own_path() : program, "run", arguments_.deck,
                             "--out", out, "--force", "--quiet"});
  for (const char* axis : {"threads", "exchange", "schedule", "progress"}) {
    const std::string value = value_of(point, axis);
    if (!value.empty()) words.insert(words.end(), {std::string("--") + axis, value});
  }
  if (arguments_.steps) words.insert(words.end(), {"--steps", std::to_string(*arguments_.steps)});
  if (arguments_.trace) words.emplace_back("--trace");
  for (const std::string& setting : settings_at(point, arguments_))
    words.insert(words.end(), {"--set", setting});
  if (!arguments_.keep) words.insert(words.end(), {"--set", "output.picture=false"});
  return words;
}

}  // namespace barchan::app

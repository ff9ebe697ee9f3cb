#include <barchan/app/command_line.hpp>

#include <map>
#include <span>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <barchan/app/options.hpp>
#include <barchan/app/verdict.hpp>
#include <barchan/core/base/nearest.hpp>
#include <barchan/tasks/results/run_summary.hpp>
#include <barchan/tasks/simulation.hpp>
#include <barchan/tasks/threads.hpp>

namespace barchan::app {
namespace {

constexpr const char* kAbout =
    "Discrete element method: disks and spheres that touch, bond and break, with the same bits on "
    "any number of ranks.";
constexpr const char* kFoot =
    "Run alone or under mpirun -n RANKS. Exit status: 0 done, 1 failed while running, 2 wrong "
    "input.\n"
    "barchan COMMAND --help lists the options of a command.";

/// `replay` records a run first, so that it is no exchange of its own.
std::vector<std::string> with_replay(std::vector<std::string> names) {
  names.emplace_back("replay");
  return names;
}

struct Words {
  std::string schedule, search, progress, trace;
};

constexpr std::string_view kTraceSteps = "steps=";

/// The steps of `--trace steps=A:B`; empty: none are named, or by wrong words.
std::optional<std::pair<std::int64_t, std::int64_t>> trace_steps(const std::string& words) {
  return words.starts_with(kTraceSteps) ? step_window(words.substr(kTraceSteps.size()))
                                        : std::nullopt;
}

/// A flag that may have a value.
void add_trace(CLI::App& command, std::string& words) {
  command
      .add_flag("--trace", words,
                "Write trace.json: tasks, messages and waits of all ranks, for Perfetto; "
                "--trace steps=A:B of these steps only")
      ->check(CLI::Validator(
          [](std::string& text) -> std::string {
            return text == "true" || trace_steps(text)
                       ? ""
                       : "'" + text + "' is no range of steps, such as steps=1000:1100";
          },
          ""));
}

/// `--trace steps=A:B` as one word: a flag takes no other as its value.
std::vector<std::string> with_joined_trace(int argc, const char* const* argv) {
  std::vector<std::string> words;
  for (const std::string word : std::span(argv, static_cast<std::size_t>(argc))) {
    if (!words.empty() && words.back() == "--trace" && word.starts_with(kTraceSteps))
      words.back() += "=" + word;
    else
      words.push_back(word);
  }
  return words;
}

void add_run(CLI::App& root, RunArguments& run, Words& words) {
  auto& [schedule, search, progress, trace] = words;
  CLI::App& command = *root.add_subcommand("run", "Run a deck and write its results into a folder");
  command.add_option("deck", run.deck, "The deck, a TOML file")
      ->required()
      ->type_name("DECK")
      ->check(not_empty());
  command
      .add_option("--out", run.out,
                  "Folder of the results; default: the deck's name with .out, here")
      ->type_name("DIR")
      ->check(not_empty());
  command.add_option("--steps", run.steps, "Number of steps, instead of the deck's")
      ->type_name("N")
      ->transform(whole_number())
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 53));
  command
      .add_option(
          "--restart", run.restart,
          "Go on from a checkpoint: 'auto' takes the newest of the folder that is whole; or "
          "its path")
      ->type_name("auto|PATH")
      ->check(not_empty());
  add_settings(command, run.settings);
  command
      .add_option("--threads", run.options.threads,
                  "Threads per rank; default: the node's cores over its ranks")
      ->type_name("T")
      ->transform(whole_number())
      ->check(CLI::Range(1, kMostThreads));
  command
      .add_option("--exchange", run.options.exchange,
                  "How ranks exchange halos: " + listed(with_replay(exchange_choices())) +
                      ", or A+B for A within a node and B between nodes; default: " +
                      exchange_choices().front())
      ->type_name("NAME")
      ->check(not_empty());
  command
      .add_option("--cuts", run.options.cuts,
                  "How ranks share the domain, instead of the deck's domain.cuts: auto, strips, or "
                  "bricks along x, y and z as in 2,2,1")
      ->type_name("CUTS")
      ->check(not_empty());
  command
      .add_option("--depth", run.options.depth,
                  "Slabs beyond each cut that a rank steps, too, so that halos may come as many "
                  "steps late; instead of the deck's exchange.depth; no bit depends on it")
      ->type_name("N")
      ->transform(whole_number())
      ->check(CLI::Range(0, kMostDepth));
  command
      .add_option("--record", run.record,
                  "With --exchange replay: the exchange of the recorded run; default: auto")
      ->type_name("NAME")
      ->check(not_empty());
  command
      .add_option("--progress", progress,
                  "Who moves messages: the workers between chunks, 'poll' (default), or a 'thread' "
                  "of its own, for ranks with a core to spare")
      ->check(one_of({"poll", "thread"}));
  command
      .add_option("--schedule", schedule,
                  "Overlap communication with work (default), or wait for messages first")
      ->check(one_of({"overlap", "sequential"}));
  command
      .add_option("--contact-search", search,
                  "How to find contacts, instead of the deck's search.kind")
      ->check(one_of({"cells", "all-pairs"}));
  command
      .add_option("--vector", run.options.vector,
                  "Width of vectors; default: auto, the widest that this machine supports")
      ->check(one_of({"auto", "scalar", "avx2", "avx512"}));
  add_trace(command, trace);
  command.add_option("--graph", run.graph, "Write the graph of a step as DOT, for Graphviz")
      ->type_name("FILE")
      ->check(not_empty());
  command.add_flag("--force", run.force, "Replace the results in a folder that exists");
  command.add_flag("--quiet", run.quiet, "Print nothing but errors");
}

void add_probe(CLI::App& root, ProbeArguments& probe) {
  CLI::App& command = *root.add_subcommand(
      "probe", "Under mpirun: measure every exchange between neighbouring ranks");
  command.add_option("--exchange", probe.options.exchanges, "Only these exchanges; default: all")
      ->type_name("NAME")
      ->delimiter(',');
  command.add_option("--bytes", probe.options.sizes, "Sizes of messages; default: 64 B to 1 MiB")
      ->type_name("N")
      ->delimiter(',')
      ->transform(whole_number())
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 48));
  command
      .add_option("--seconds", probe.options.budget_seconds,
                  "For each measurement, five of which make a line; default: 0.05")
      ->type_name("T")
      ->check(CLI::Range(1e-4, 60.0));
  command
      .add_option("--repeat", probe.options.repetitions,
                  "Repetitions of each measurement, instead of --seconds")
      ->type_name("N")
      ->transform(whole_number())
      ->check(CLI::Range(1, 1 << 24));
  auto* json = command.add_flag("--json", probe.json, "Print JSON instead of tables");
  command.add_flag("--csv", probe.csv, "Print CSV instead of tables")->excludes(json);
}

void add_others(CLI::App& root, CommandLine& line) {
  CLI::App& check = *root.add_subcommand(
      "check", "Print what a deck would do, and whether its time step is stable");
  check.add_option("deck", line.check.deck, "The deck, a TOML file")
      ->required()
      ->type_name("DECK")
      ->check(not_empty());
  check.add_option("--ranks", line.check.ranks, "Show the cuts for this number of ranks")
      ->type_name("P")
      ->transform(whole_number())
      ->check(CLI::Range(1, 1 << 20));
  add_settings(check, line.check.settings);

  CLI::App& info =
      *root.add_subcommand("info", "Print what a file or folder is, and its key figures");
  info.add_option("path", line.info_path, "A run folder, snapshot, particle file, series or deck")
      ->required()
      ->type_name("PATH")
      ->check(not_empty());

  CLI::App& convert = *root.add_subcommand(
      "convert", "Convert particles and bonds: .csv, LAMMPS data (.data, .lmp), .vtp");
  convert
      .add_option("in", line.convert.in,
                  "File to read; also a .pvtp of all ranks, or packed as .gz")
      ->required()
      ->type_name("IN")
      ->check(not_empty());
  convert.add_option("out", line.convert.out, "File to write; its ending selects the format")
      ->required()
      ->type_name("OUT")
      ->check(not_empty());
  convert
      .add_option("--dimension", line.convert.dimension,
                  "2 or 3; default: 2 where all particles lie in the plane z = 0")
      ->type_name("D")
      ->transform(whole_number())
      ->check(CLI::IsMember({2, 3}));
  convert
      .add_option("--data-density", line.convert.density,
                  "What densities of LAMMPS data mean in 2D: of a 'sphere' of that mass, as LAMMPS "
                  "takes them (default), or of the 'disk'")
      ->check(one_of({"sphere", "disk"}));
  convert.add_flag("--force", line.convert.force, "Replace a file that exists");
}

/// The option or command that was probably meant; empty when none comes close.
std::string meant(const CLI::App& root, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* command : root.get_subcommands({})) {
    const bool is_used = command->parsed();
    if (word.rfind('-', 0) != 0) names.push_back(command->get_name());
    if (!is_used) continue;
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
  }
  const std::vector<std::string_view> views(names.begin(), names.end());
  return std::string(deck::nearest(word.substr(0, word.find('=')), views));
}

std::string explain(const CLI::App& root, const CLI::ParseError& error, int argc) {
  std::string text = error.what();
  const auto end = text.find_last_not_of("\n ");
  text.resize(end == std::string::npos ? 0 : end + 1);
  std::string remedy = "see --help";
  const auto rest = root.remaining(true);
  if (argc <= 1)
    text = "no command";
  else if (!rest.empty()) {
    text = (rest.front().rfind('-', 0) == 0 ? "unknown option '" : "unexpected argument '") +
           rest.front() + "'";
    const std::string name = meant(root, rest.front());
    if (!name.empty()) remedy = "did you mean '" + name + "'?";
  }
  return fmt::format("barchan: {} ({})\n", text, remedy);
}

CommandKind kind_of(const CLI::App& root) {
  static const std::map<std::string, CommandKind> kKinds{
      {"run", CommandKind::Run},         {"check", CommandKind::Check},
      {"info", CommandKind::Info},       {"probe", CommandKind::Probe},
      {"convert", CommandKind::Convert}, {"sweep", CommandKind::Sweep},
      {"table", CommandKind::Table},     {"compare", CommandKind::Compare},
      {"report", CommandKind::Report},   {"watch", CommandKind::Watch}};
  const auto found = kKinds.find(root.get_subcommands().front()->get_name());
  return found == kKinds.end() ? CommandKind::Text : found->second;
}

}  // namespace

CommandLine parse_command_line(int argc, const char* const* argv) {
  CommandLine line;
  CLI::App root(kAbout, "barchan");
  root.footer(kFoot);
  root.require_subcommand(1);
  root.fallthrough(false);
  root.set_version_flag("--version", "barchan " + version());
  Words words;
  add_run(root, line.run, words);
  add_probe(root, line.probe);
  add_others(root, line);
  add_experiments(root, line);
  TextWords texts;
  add_texts(root, texts);
  for (CLI::App* command : root.get_subcommands({}))
    command->set_version_flag("--version", "barchan " + version());
  try {
    const std::vector<std::string> all = with_joined_trace(argc, argv);
    std::vector<const char*> pointers;
    for (const std::string& word : all) pointers.push_back(word.c_str());
    root.parse(static_cast<int>(pointers.size()), pointers.data());
  } catch (const CLI::Success& asked) {
    std::ostringstream out, ignored;
    root.exit(asked, out, ignored);
    line.text = out.str();
    return line;
  } catch (const CLI::ParseError& error) {
    line.status = kWrongInput;
    line.text = explain(root, error, argc);
    return line;
  }
  line.kind = kind_of(root);
  if (line.kind == CommandKind::Text)
    line.status = with_verdict(nullptr, [&] { line.text = text_of(root, texts); });
  if (words.schedule == "sequential") line.run.options.schedule = Schedule::Sequential;
  line.run.options.trace = !words.trace.empty();
  line.run.options.trace_steps = trace_steps(words.trace);
  if (words.progress == "thread") line.run.options.progress = Progress::Thread;
  if (!words.search.empty())
    line.run.options.search =
        words.search == "cells" ? ContactSearchKind::Cells : ContactSearchKind::AllPairs;
  return line;
}

}  // namespace barchan::app

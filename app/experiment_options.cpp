#include <charconv>

#include <barchan/app/options.hpp>
#include <barchan/core/base/nearest.hpp>

namespace barchan::app {
namespace {

constexpr const char* kSweepFoot =
    "Every combination of the values is a point. All points run once, then all again in the other "
    "order, so that what is compared was measured at nearly the same time. The same command goes "
    "on with a sweep that was cut off, and more values or repetitions add to one that is there.\n"
    "  barchan sweep deck.toml --out lab --exchange isend,put-inband --schedule overlap,sequential "
    "--lab hosts=2,delay=0:200us:1ms,rate=1gbit\n"
    "  barchan sweep deck.toml --out scaling --ranks 1,2,4,8 --launcher 'srun -n {ranks}'\n"
    "  barchan table lab --against schedule=sequential";
constexpr const char* kCompareFoot =
    "A and B are folders of runs or of sweeps. FOLDER:AXIS=VALUE,... takes some points of a sweep, "
    "and points that are equal but for these axes are compared:\n"
    "  barchan compare lab:exchange=isend lab:exchange=put-inband\n"
    "  barchan compare before.out after.out";

template <class Value>
CLI::Option& add_axis(CLI::App& command, const char* name, std::vector<Value>& values,
                      const std::string& about) {
  return *command.add_option(name, values, about)->delimiter(',')->check(not_empty());
}

void add_axes(CLI::App& command, SweepArguments& sweep) {
  add_axis(command, "--ranks", sweep.ranks, "Numbers of ranks; default: 2, in the lab one a host")
      .type_name("P,...")
      ->transform(whole_number())
      ->check(CLI::Range(1, 1 << 20));
  add_axis(command, "--threads", sweep.threads, "Threads per rank; default: 1")
      .type_name("T,...")
      ->transform(whole_number())
      ->check(CLI::Range(1, 1024));
  add_axis(command, "--exchange", sweep.exchanges, "Exchanges, as of run; default: auto")
      .type_name("NAME,...");
  add_axis(command, "--schedule", sweep.schedules, "Schedules; default: overlap")
      .type_name("NAME,...")
      ->check(one_of({"overlap", "sequential"}));
  add_axis(command, "--progress", sweep.progress, "Who moves messages; default: poll")
      .type_name("NAME,...")
      ->check(one_of({"poll", "thread"}));
  command
      .add_option("--vary", sweep.vary,
                  "A key of the deck and its values, such as time.step=1e-4,2e-4; again for more")
      ->type_name("KEY=VALUE,...")
      ->take_all()
      ->allow_extra_args(false);
  add_axis(command, "--barchan", sweep.commands,
           "Programs to compare, such as builds of two versions; default: this one")
      .type_name("PATH,...");
}

void add_sweep(CLI::App& root, SweepArguments& sweep) {
  CLI::App& command = *root.add_subcommand(
      "sweep", "Run a deck at every combination of ranks, exchanges, delays, ..., repeatedly");
  command.footer(kSweepFoot);
  command.add_option("deck", sweep.deck, "The deck, a TOML file")
      ->required()
      ->type_name("DECK")
      ->check(not_empty());
  command
      .add_option("--out", sweep.out, "Folder of the sweep; default: the deck's name with .sweep")
      ->type_name("DIR")
      ->check(not_empty());
  add_axes(command, sweep);
  command.add_option("--repeat", sweep.repeat, "Repetitions of every point; default: 3")
      ->type_name("N")
      ->transform(whole_number())
      ->check(CLI::Range(1, 10000));
  command.add_option("--steps", sweep.steps, "Number of steps, instead of the deck's")
      ->type_name("N")
      ->transform(whole_number())
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 53));
  add_settings(command, sweep.settings);
  auto* launcher =
      command
          .add_option("--launcher", sweep.launcher,
                      "What starts a run, such as 'srun -n {ranks} -c {threads}'; default: mpirun")
          ->type_name("WORDS")
          ->check(not_empty());
  command
      .add_option("--lab", sweep.lab,
                  "Run between emulated hosts (as root): hosts=2,delay=0:200us:1ms,rate=1gbit; "
                  "values after ':' are further points; other words as of barchan-netlab, and osc, "
                  "Open MPI's one-sided component")
      ->type_name("WORD=VALUE,...")
      ->check(not_empty())
      ->excludes(launcher);
  command
      .add_option("--minutes", sweep.minutes, "Begin no repetition that would end later than this")
      ->type_name("T")
      ->check(CLI::PositiveNumber);
  command.add_flag("--trace", sweep.trace, "Write the trace of every run, too");
  command.add_flag("--keep", sweep.keep, "Keep the snapshots of every run");
  command.add_flag("--force", sweep.force, "Replace a sweep of another deck in the folder");
  command.add_flag("--quiet", sweep.quiet, "Print nothing but errors");
}

void add_table(CLI::App& root, TableArguments& table) {
  CLI::App& command = *root.add_subcommand(
      "table", "Print a sweep, or the runs in a folder: medians, spreads, ratios, digests");
  command.add_option("folder", table.path, "Folder of a sweep, or of folders of runs")
      ->required()
      ->type_name("DIR")
      ->check(not_empty());
  command
      .add_option("--against", table.against,
                  "What ratios are to: the point with these values, such as exchange=isend; "
                  "default: the first point")
      ->type_name("AXIS=VALUE,...")
      ->check(not_empty());
  const auto format = [&](const char* name, const char* about, TableFormat value) {
    return command.add_flag_callback(
        name, [&table, value] { table.format = value; }, about);
  };
  auto* csv = format("--csv", "Print CSV, a row for every run", TableFormat::Csv);
  auto* json = format("--json", "Print JSON, with every run", TableFormat::Json);
  auto* markdown = format("--md", "Print a Markdown table", TableFormat::Markdown);
  csv->excludes(json)->excludes(markdown);
  json->excludes(markdown);
}

void add_compare(CLI::App& root, CompareArguments& compare) {
  CLI::App& command = *root.add_subcommand(
      "compare", "Compare two runs, sweeps or builds: times with confidence, what differs");
  command.footer(kCompareFoot);
  command.add_option("a", compare.a, "Folder of a run or sweep, perhaps :AXIS=VALUE,...")
      ->required()
      ->type_name("A")
      ->check(not_empty());
  command.add_option("b", compare.b, "What to compare with it")
      ->required()
      ->type_name("B")
      ->check(not_empty());
  command.add_option("--confidence", compare.confidence, "Of the intervals; default: 0.95")
      ->type_name("C")
      ->check(CLI::Range(0.5, 0.999));
  command.add_flag("--json", compare.json, "Print JSON instead of tables");
}

/// A:B as two numbers.
void add_report(CLI::App& root, ReportArguments& report) {
  CLI::App& command = *root.add_subcommand(
      "report",
      "Write a page for a browser: particles, plots, timeline, sweep, or what a deck makes");
  command.add_option("path", report.path, "Folder of a run or sweep, or a deck")
      ->required()
      ->type_name("RUN|DIR|DECK")
      ->check(not_empty());
  command
      .add_option("--out", report.out, "The page; default: report.html in the folder, or DECK.html")
      ->type_name("FILE")
      ->check(not_empty());
  command.add_option("--frames", report.frames, "The most snapshots to show; default: 40")
      ->type_name("N")
      ->transform(whole_number())
      ->check(CLI::Range(1, 10000));
  command
      .add_option_function<std::string>(
          "--steps", [&report](const std::string& text) { report.steps = step_window(text); },
          "Steps of the timeline, such as 1000:1010; default: the last ones of the trace")
      ->type_name("A:B")
      ->check(CLI::Validator(
          [](std::string& text) -> std::string {
            return step_window(text) ? ""
                                     : "'" + text + "' is no range of steps, such as 1000:1010";
          },
          ""));
  add_settings(command, report.settings);
}

void add_watch(CLI::App& root, WatchArguments& watch) {
  CLI::App& command = *root.add_subcommand(
      "watch", "Show how far a run is: step, time left, rate, hidden communication, energies");
  command.add_option("folder", watch.path, "Folder of the run")
      ->required()
      ->type_name("RUN")
      ->check(not_empty());
  command.add_option("--interval", watch.interval, "Seconds between looks; default: 1")
      ->type_name("T")
      ->check(CLI::Range(0.1, 3600.0));
  command.add_flag("--once", watch.once, "Look once, and end");
}

}  // namespace

void add_experiments(CLI::App& root, CommandLine& line) {
  add_sweep(root, line.sweep);
  add_table(root, line.table);
  add_compare(root, line.compare);
  add_report(root, line.report);
  add_watch(root, line.watch);
}

}  // namespace barchan::app

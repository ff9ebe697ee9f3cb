#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <barchan/comm/probe/probe.hpp>
#include <barchan/tasks/run_options.hpp>

namespace barchan::app {

inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;
inline constexpr int kWrongInput = 2;

enum class CommandKind {
  Text,
  Run,
  Check,
  Info,
  Probe,
  Convert,
  Sweep,
  Table,
  Compare,
  Report,
  Watch
};

struct RunArguments {
  std::string deck;
  std::string out;  ///< empty: by the deck's name
  std::optional<std::int64_t> steps;
  std::string restart;                ///< empty, "auto" or a path
  std::vector<std::string> settings;  ///< key=value
  RunOptions options;
  std::string graph;            ///< file for the step graph; empty: none
  std::string record = "auto";  ///< exchange of the run that `--exchange replay` records
  bool force = false;
  bool quiet = false;
};

struct CheckArguments {
  std::string deck;
  std::vector<std::string> settings;
  int ranks = 0;  ///< 0: a few usual ones
};

struct ProbeArguments {
  ProbeOptions options;
  bool json = false, csv = false;
};

struct ConvertArguments {
  std::string in, out;
  int dimension = 0;               ///< 0: 2 when everything lies in the plane z = 0
  std::string density = "sphere";  ///< of LAMMPS data in 2D: "sphere" or "disk"
  bool force = false;
};

struct SweepArguments {
  std::string deck, out;
  std::vector<int> ranks;  ///< empty: 2, or as many as the lab has hosts
  std::vector<int> threads{1};
  std::vector<std::string> exchanges{"auto"}, schedules{"overlap"}, progress{"poll"};
  std::vector<std::string> vary;      ///< KEY=VALUE,VALUE,...
  std::vector<std::string> settings;  ///< key=value, of all runs
  std::vector<std::string> commands;  ///< paths of barchan; empty: this one
  std::optional<std::int64_t> steps;
  int repeat = 3;
  std::string launcher, lab;
  double minutes = 0.0;  ///< 0: no limit
  bool keep = false, trace = false, force = false, quiet = false;
};

enum class TableFormat { Text, Csv, Json, Markdown };

struct TableArguments {
  std::string path;
  std::string against;  ///< axis=value,... of the point that ratios are to
  TableFormat format = TableFormat::Text;
};

struct CompareArguments {
  std::string a, b;
  double confidence = 0.95;
  bool json = false;
};

struct ReportArguments {
  std::string path;
  std::string out;                    ///< empty: in the folder, or by the deck's name
  std::vector<std::string> settings;  ///< key=value, of a deck
  int frames = 40;                    ///< snapshots at most
  std::optional<std::pair<std::int64_t, std::int64_t>> steps;  ///< of the timeline
};

struct WatchArguments {
  std::string path;
  double interval = 1.0;  ///< [s]
  bool once = false;
};

/// What the user asked for.
struct CommandLine {
  CommandKind kind = CommandKind::Text;
  int status = kDone;  ///< Text: the exit status
  std::string text;    ///< Text: help, version or what is wrong
  RunArguments run;
  CheckArguments check;
  std::string info_path;
  ProbeArguments probe;
  ConvertArguments convert;
  SweepArguments sweep;
  TableArguments table;
  CompareArguments compare;
  ReportArguments report;
  WatchArguments watch;
};

/// Never throws: what is wrong becomes a text with status 2.
CommandLine parse_command_line(int argc, const char* const* argv);

}  // namespace barchan::app

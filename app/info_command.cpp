#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include <barchan/app/commands.hpp>
#include <barchan/app/loaded_deck.hpp>
#include <barchan/app/readable.hpp>
#include <barchan/app/run_view.hpp>
#include <barchan/core/base/error.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/text_file.hpp>
#include <barchan/core/io/vtp.hpp>

namespace fs = std::filesystem;

namespace barchan::app {
namespace {

void print(const std::string& path, const std::string& what, const Rows& rows) {
  std::printf("%s: %s\n%s", path.c_str(), what.c_str(), table(rows, 2).c_str());
}

/// What a .pvd lists, without the bonds that stand beside particles.
std::vector<PvdEntry> times_of(const std::string& path) {
  std::vector<PvdEntry> entries = read_pvd(path);
  std::erase_if(entries, [](const PvdEntry& entry) { return entry.part != 0; });
  return entries;
}

void show_folder(const std::string& path) {
  const std::string json = path + "/run.json";
  if (!fs::exists(json)) {
    const bool is_started = fs::exists(path + "/series.csv");
    throw InputError(
        SourcePlace{path, 0, 0},
        is_started ? "a run that has not ended: run.json is missing" : "is not a folder of a run",
        is_started ? "wait for it, or run it again"
                   : "give a run's folder, a snapshot, a particle file or a deck");
  }
  Rows rows = run_rows(read_text_file(json), json);
  if (fs::exists(path + "/snapshots/run.pvd")) {
    rows.push_back({"snapshots", std::to_string(times_of(path + "/snapshots/run.pvd").size())});
  }
  print(path, "a run's results", rows);
}

void show_pvd(const std::string& path) {
  const auto entries = times_of(path);
  Rows rows{{"snapshots", std::to_string(entries.size())}};
  if (!entries.empty())
    rows.push_back({"time", range(entries.front().time, entries.back().time) + " s"});
  print(path, "snapshots over time", rows);
}

void add_instant(const std::string& path, Rows& rows) {
  std::string piece = path;
  if (path.ends_with(".pvtp")) {
    const auto pieces = read_pvtp(path);
    rows.push_back({"ranks", std::to_string(pieces.size())});
    if (pieces.empty()) return;
    piece = pieces.front();
  }
  const VtpPiece read = read_vtp(piece);
  rows.push_back({"time", fmt::format("{:.6g} s, step {}", read.time, grouped(read.step))});
}

const char* kind_in_words(ParticleFormat format) {
  if (format == ParticleFormat::LammpsData) return "a LAMMPS data file";
  return format == ParticleFormat::Csv ? "a table of particles" : "a snapshot";
}

void show_particles(const std::string& path) {
  const ParticleFile file = read_particles(path);
  Rows rows;
  if (path.ends_with("vtp")) add_instant(path, rows);
  double r_lo = 1e300, r_hi = 0.0, speed = 0.0;
  Vec3 lo = Vec3::Constant(1e300), hi = Vec3::Constant(-1e300);
  std::int32_t types = 0;
  for (const ParticleData& p : file.particles) {
    r_lo = std::min(r_lo, p.radius);
    r_hi = std::max(r_hi, p.radius);
    lo = lo.cwiseMin(p.position);
    hi = hi.cwiseMax(p.position);
    speed = std::max(speed, p.velocity.norm());
    types = std::max(types, p.type + 1);
  }
  rows.push_back({"particles", grouped(static_cast<std::int64_t>(file.particles.size()))});
  rows.push_back({"types", std::to_string(types)});
  rows.push_back({"radius", range(r_lo, r_hi) + " m"});
  const bool is_flat = lo.z() == 0.0 && hi.z() == 0.0;
  for (int c = 0; c < (is_flat ? 2 : 3); ++c)
    rows.push_back({std::string(1, "xyz"[c]), range(lo[c], hi[c]) + " m"});
  rows.push_back({"speed", fmt::format("at most {:.4g} m/s", speed)});
  if (file.has_bonds)
    rows.push_back({"bonds", grouped(static_cast<std::int64_t>(file.bonds.size()))});
  for (const std::string& note : file.notes) rows.push_back({"note", note});
  print(path, kind_in_words(*particle_format(path)), rows);
}

bool show_series(const std::string& path) {
  const std::string text = read_text_file(path);
  if (!is_series(text)) return false;
  print(path, "a series over time", series_rows(text, path));
  return true;
}

void show_deck(const std::string& path) {
  const Deck deck = read_deck(path);
  const Model& m = deck.model;
  print(path, "a deck",
        {{"title", m.title},
         {"dimension", std::to_string(m.dimension)},
         {"materials", std::to_string(m.materials.size())},
         {"sources", std::to_string(deck.sources.size()) + " of particles"},
         {"walls", std::to_string(m.walls.size())},
         {"stages", std::to_string(m.stages.size())},
         {"steps", fmt::format("{} of {:g} s", grouped(m.time.num_steps), m.time.step)},
         {"more", "barchan check " + path}});
}

}  // namespace

void show_info(const std::string& path) {
  if (!fs::exists(path))
    throw InputError(SourcePlace{path, 0, 0}, "there is no such file or folder",
                     "give the path of one");
  if (fs::is_directory(path)) return show_folder(path);
  if (path.ends_with(".toml")) return show_deck(path);
  if (path.ends_with(".pvd")) return show_pvd(path);
  if (path.ends_with(".json"))
    return print(path, "a run in numbers", run_rows(read_text_file(path), path));
  if (path.ends_with(".csv") && show_series(path)) return;
  if (particle_format(path)) return show_particles(path);
  throw InputError(
      SourcePlace{path, 0, 0}, "barchan does not know this kind of file",
      "give a run's folder, .toml, .csv, .tsv, .data, .lmp, .vtp, .pvtp, .pvd or run.json");
}

}  // namespace barchan::app

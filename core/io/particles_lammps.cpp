#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <unordered_map>

#include <fmt/format.h>

#include <barchan/core/error.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/text_file.hpp>

namespace barchan {
namespace {

constexpr const char* kExpected = "id type diameter density x y z, optionally three image flags";

std::string_view without_comment(std::string_view line) {
  return trimmed(line.substr(0, line.find('#')));
}

bool is_section(std::string_view content) {
  return !content.empty() && std::isalpha(static_cast<unsigned char>(content.front())) != 0;
}

/// Words of a row; more than the longest row has are counted as one too many.
struct Words {
  std::array<std::string_view, 11> at{};
  std::size_t count = 0;
};

Words words_of(std::string_view content) {
  Words words;
  for (std::string_view word = take_word(content); !word.empty() && words.count < words.at.size();
       word = take_word(content)) {
    words.at[words.count++] = word;
  }
  return words;
}

/// Reads one data file; each member reads a part and leaves the line reader behind it.
class DataFile {
 public:
  DataFile(std::string_view text, const std::string& file) : lines_(text, file) {
    result_.file = file;
  }

  ParticleFile read() {
    std::string_view line;
    if (lines_.next(line))
      result_.has_sphere_density = line.find("LIGGGHTS") == std::string_view::npos;
    while (lines_.next(line)) {
      const std::string_view content = without_comment(line);
      if (content.empty()) continue;
      if (is_section(content)) {
        enter_section(content, line);
      } else if (section_ == Section::Header) {
        read_header_line(content);
      } else if (section_ == Section::Atoms) {
        read_atom(content);
      } else if (section_ == Section::Velocities) {
        read_velocity(content);
      }
    }
    finish();
    return std::move(result_);
  }

 private:
  enum class Section { Header, Atoms, Velocities, Skipped };

  void enter_section(std::string_view content, std::string_view line) {
    if (content == "Atoms") {
      if (has_atoms_) throw InputError(lines_.place(), "a second Atoms section", "keep one");
      check_style(line);
      has_atoms_ = true;
      section_ = Section::Atoms;
    } else if (content == "Velocities") {
      if (!has_atoms_)
        throw InputError(lines_.place(), "Velocities before Atoms", "put Atoms first");
      index_ids();
      section_ = Section::Velocities;
    } else if (content == "Masses" || content == "Pair Coeffs" || content == "PairIJ Coeffs") {
      section_ = Section::Skipped;
    } else {
      throw InputError(
          lines_.place(content), in_quotes(content) + " is not a section that is understood",
          "Atoms and Velocities are read; Masses, Pair Coeffs and PairIJ Coeffs are ignored");
    }
  }

  void check_style(std::string_view line) const {
    const std::size_t hash = line.find('#');
    if (hash == std::string_view::npos) return;
    std::string_view comment = line.substr(hash + 1);
    const std::string_view style = take_word(comment);
    if (style.empty() || style == "sphere" || style == "granular") return;
    throw InputError(lines_.place(style), "atom style " + in_quotes(style) + " is not understood",
                     std::string("atom style sphere: ") + kExpected);
  }

  void read_header_line(std::string_view content) {
    const Words words = words_of(content);
    const auto ends_with = [&](std::initializer_list<std::string_view> tail) {
      return words.count >= tail.size() &&
             std::equal(tail.begin(), tail.end(),
                        words.at.begin() + static_cast<std::ptrdiff_t>(words.count - tail.size()));
    };
    constexpr std::array<std::string_view, 3> kLow = {"xlo", "ylo", "zlo"};
    constexpr std::array<std::string_view, 3> kHigh = {"xhi", "yhi", "zhi"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (words.count != 4 || !ends_with({kLow[axis], kHigh[axis]})) continue;
      read_bounds(words, static_cast<int>(axis));
      return;
    }
    if (words.count == 2 && ends_with({"atoms"})) {
      num_atoms_ = parse_integer(words.at[0], "number of atoms", lines_);
    } else if (ends_with({"xy", "xz", "yz"})) {
      throw InputError(lines_.place(), "the box is tilted", "use a box with right angles");
    } else if (words.count < 2 || words.count > 3 || ends_with({"avec"})) {
      throw InputError(lines_.place(), in_quotes(content) + " is not understood in the header",
                       "N atoms, N atom types, and xlo xhi, ylo yhi, zlo zhi belong here");
    } else {
      (void)parse_integer(words.at[0], content.substr(words.at[0].size()), lines_);
    }
  }

  void read_bounds(const Words& words, int axis) {
    const double lo = parse_number(words.at[0], words.at[2], lines_);
    const double hi = parse_number(words.at[1], words.at[3], lines_);
    if (!(lo < hi))
      throw InputError(lines_.place(), "the box is empty", "the low bound is below the high one");
    if (!result_.box) result_.box.emplace();
    result_.box->lo[axis] = lo;
    result_.box->hi[axis] = hi;
    has_bounds_[static_cast<std::size_t>(axis)] = true;
  }

  void read_atom(std::string_view content) {
    const Words words = words_of(content);
    if (words.count != 7 && words.count != 10) {
      throw InputError(lines_.place(), fmt::format("{} fields in a row of Atoms", words.count),
                       kExpected);
    }
    ParticleData particle;
    particle.id = parse_integer(words.at[0], "id", lines_);
    const std::int64_t type = parse_integer(words.at[1], "type", lines_);
    const bool fits = type >= 1 && type <= std::numeric_limits<std::int32_t>::max();
    particle.type = fits ? static_cast<std::int32_t>(type - 1) : -1;
    particle.radius = 0.5 * parse_number(words.at[2], "diameter", lines_);
    particle.density = parse_number(words.at[3], "density", lines_);
    for (int axis = 0; axis < 3; ++axis) {
      particle.position[axis] =
          parse_number(words.at[static_cast<std::size_t>(4 + axis)], "a coordinate", lines_);
    }
    for (std::size_t i = 7; i < words.count; ++i)
      (void)parse_integer(words.at[i], "an image flag", lines_);
    check_particle_row(particle, lines_);
    result_.particles.push_back(particle);
    result_.lines.push_back(lines_.number());
  }

  void index_ids() {
    check_particle_file(result_);
    index_of_.reserve(result_.particles.size());
    for (std::size_t i = 0; i < result_.particles.size(); ++i)
      index_of_.emplace(result_.particles[i].id, i);
  }

  void read_velocity(std::string_view content) {
    const Words words = words_of(content);
    if (words.count != 7) {
      throw InputError(lines_.place(), fmt::format("{} fields in a row of Velocities", words.count),
                       "id vx vy vz wx wy wz");
    }
    const auto found = index_of_.find(parse_integer(words.at[0], "id", lines_));
    if (found == index_of_.end()) {
      throw InputError(lines_.place(words.at[0]),
                       "velocity of an unknown id " + in_quotes(words.at[0]),
                       "every id of Velocities appears in Atoms");
    }
    ParticleData& particle = result_.particles[found->second];
    for (int axis = 0; axis < 3; ++axis) {
      particle.velocity[axis] =
          parse_number(words.at[static_cast<std::size_t>(1 + axis)], "a velocity", lines_);
      particle.omega[axis] =
          parse_number(words.at[static_cast<std::size_t>(4 + axis)], "an angular velocity", lines_);
    }
  }

  void finish() const {
    const SourcePlace place{result_.file, 0, 0};
    if (!has_atoms_)
      throw InputError(place, "has no Atoms section", std::string("Atoms # sphere: ") + kExpected);
    if (!(has_bounds_[0] && has_bounds_[1] && has_bounds_[2])) {
      throw InputError(place, "the box is incomplete",
                       "the header gives xlo xhi, ylo yhi and zlo zhi");
    }
    check_particle_file(result_);
    const auto found = static_cast<std::int64_t>(result_.particles.size());
    if (num_atoms_ == found) return;
    throw InputError(place, fmt::format("{} rows in Atoms", found),
                     fmt::format("the header announces {} atoms", num_atoms_));
  }

  LineReader lines_;
  ParticleFile result_;
  Section section_ = Section::Header;
  std::int64_t num_atoms_ = 0;
  bool has_atoms_ = false;
  std::array<bool, 3> has_bounds_{};
  std::unordered_map<std::int64_t, std::size_t> index_of_;
};

void write_header(OutputFile& file, std::span<const ParticleData> particles, const Box& box,
                  int dimension) {
  std::int32_t last_type = 0;
  double thickest = 0.0;
  for (const ParticleData& p : particles) {
    last_type = std::max(last_type, p.type);
    thickest = std::max(thickest, p.radius);
  }
  const double z_lo = dimension == 2 ? -2.0 * thickest : box.lo.z();
  const double z_hi = dimension == 2 ? 2.0 * thickest : box.hi.z();
  file.write(fmt::format("Particles written by barchan\n\n{} atoms\n{} atom types\n\n",
                         particles.size(), last_type + 1));
  file.write(fmt::format("{:.17g} {:.17g} xlo xhi\n", box.lo.x(), box.hi.x()));
  file.write(fmt::format("{:.17g} {:.17g} ylo yhi\n", box.lo.y(), box.hi.y()));
  file.write(fmt::format("{:.17g} {:.17g} zlo zhi\n", z_lo, z_hi));
}

}  // namespace

ParticleFile parse_particles_lammps(std::string_view text, const std::string& file) {
  return DataFile(text, file).read();
}

ParticleFile read_particles_lammps(const std::string& path) {
  return parse_particles_lammps(read_text_file(path), path);
}

void write_particles_lammps(const std::string& path, std::span<const ParticleData> particles,
                            const Box& box, int dimension) {
  OutputFile file(path);
  write_header(file, particles, box, dimension);
  file.write("\nAtoms # sphere\n\n");
  for (const ParticleData& p : particles) {
    const double density = dimension == 2 ? p.density / (4.0 / 3.0 * p.radius) : p.density;
    file.write(fmt::format("{} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", p.id, p.type + 1,
                           2.0 * p.radius, density, p.position.x(), p.position.y(),
                           p.position.z()));
  }
  file.write("\nVelocities\n\n");
  for (const ParticleData& p : particles) {
    file.write(fmt::format("{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", p.id,
                           p.velocity.x(), p.velocity.y(), p.velocity.z(), p.omega.x(), p.omega.y(),
                           p.omega.z()));
  }
  file.commit();
}

}  // namespace barchan

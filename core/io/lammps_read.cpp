#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <unordered_map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/lammps_words.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/plain_text.hpp>
#include <barchan/core/io/text_file.hpp>

namespace barchan {
namespace {

using Words = LammpsWords;
using Section = LammpsSection;

bool is_section(std::string_view content) {
  return !content.empty() && std::isalpha(static_cast<unsigned char>(content.front())) != 0;
}

std::int32_t parse_type(std::string_view word, const LineReader& lines) {
  const std::int64_t type = parse_integer(word, "type", lines);
  const bool fits = type >= 1 && type <= std::numeric_limits<std::int32_t>::max();
  return fits ? static_cast<std::int32_t>(type - 1) : -1;
}

/// Reads one data file; each member reads a part and leaves the line reader behind it.
class DataFile {
 public:
  DataFile(std::string_view text, const std::string& file) : lines_(text, file) {
    result_.file = file;
    result_.has_sphere_density = true;
  }

  ParticleFile read() {
    std::string_view line;
    while (lines_.next(line)) {
      const std::string_view content = without_comment(line);
      if (lines_.number() == 1 && is_title(line, content)) continue;
      if (content.empty()) continue;
      if (is_section(content)) {
        enter_section(content, line);
      } else {
        read_line(content, line);
      }
    }
    finish();
    return std::move(result_);
  }

 private:
  bool is_title(std::string_view line, std::string_view content) const {
    if (line.starts_with("ITEM:"))
      throw InputError(lines_.place(), "this is a LAMMPS dump, not a data file",
                       "write a data file by write_data, or the dump as a .csv");
    return !is_lammps_header_line(Words(content));
  }

  void read_line(std::string_view content, std::string_view line) {
    if (section_ == Section::Header) read_header_line(content);
    if (section_ == Section::Atoms) read_atom(content);
    if (section_ == Section::Velocities) read_velocity(content);
    if (section_ == Section::Bonds) read_bond(content, line);
  }

  void enter_section(std::string_view content, std::string_view line) {
    const LammpsSectionRule* rule = find_lammps_section(content);
    if (rule == nullptr)
      throw InputError(lines_.place(content),
                       in_quotes(content) + " is not a section that is understood",
                       "Atoms, Velocities and Bonds are read; Masses, Coeffs, Angles and the like "
                       "are passed over");
    section_ = rule->kind;
    if (section_ == Section::Skipped) {
      skipped_.push_back(rule->name);
      return;
    }
    bool& is_there = is_there_[static_cast<std::size_t>(section_)];
    if (is_there)
      throw InputError(lines_.place(), fmt::format("a second {} section", content), "keep one");
    is_there = true;
    if (section_ == Section::Atoms) return take_style(line);
    if (!has(Section::Atoms))
      throw InputError(lines_.place(), fmt::format("{} before Atoms", content), "put Atoms first");
    if (section_ == Section::Bonds) result_.has_bonds = true;
    index_ids();
  }

  void take_style(std::string_view line) {
    std::string_view comment = comment_of(line);
    const std::string_view name = take_word(comment);
    if (name.empty()) {
      result_.notes.push_back("Atoms names no style and is read as sphere: " +
                              std::string(lammps_row(style_)));
      return;
    }
    for (const LammpsStyleRule& rule : lammps_styles()) {
      if (rule.name != name) continue;
      style_ = rule.style;
      return;
    }
    throw InputError(
        lines_.place(name), "atom style " + in_quotes(name) + " is not understood",
        fmt::format("write the file with atom style sphere ({}) or bpm/sphere ({})",
                    lammps_row(LammpsStyle::Sphere), lammps_row(LammpsStyle::BpmSphere)));
  }

  void read_header_line(std::string_view content) {
    const Words words(content);
    constexpr std::array<std::string_view, 3> kLow = {"xlo", "ylo", "zlo"};
    constexpr std::array<std::string_view, 3> kHigh = {"xhi", "yhi", "zhi"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (words.count != 4 || !words.ends_with({kLow[axis], kHigh[axis]})) continue;
      read_bounds(words, static_cast<int>(axis));
      return;
    }
    if (words.count == 6 && words.ends_with({"xy", "xz", "yz"})) return read_tilt(words);
    if (!is_lammps_count(words))
      throw InputError(lines_.place(), in_quotes(content) + " is not understood in the header",
                       "N atoms, N atom types, and xlo xhi, ylo yhi, zlo zhi belong here");
    const std::int64_t number =
        parse_integer(words.at[0], content.substr(words.at[0].size() + 1), lines_);
    if (words.count == 2 && words.at[1] == "atoms") num_atoms_ = number;
    if (words.count == 2 && words.at[1] == "bonds") num_bonds_ = number;
    has_bond_count_ |= words.at[1] == "bonds";
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

  void read_tilt(const Words& words) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (parse_number(words.at[i], words.at[i + 3], lines_) != 0.0)
        throw InputError(lines_.place(), "the box is tilted", "use a box with right angles");
    }
  }

  void read_atom(std::string_view content) {
    const Words words(content);
    const std::size_t before = style_ == LammpsStyle::BpmSphere ? 1 : 0;  // the molecule
    if (words.count != before + 7 && words.count != before + 10) {
      throw InputError(lines_.place(), fmt::format("{} fields in a row of Atoms", words.count),
                       std::string(lammps_row(style_)));
    }
    ParticleData particle;
    particle.id = parse_integer(words.at[0], "id", lines_);
    if (before > 0) (void)parse_integer(words.at[1], "molecule", lines_);
    const auto* word = words.at.data() + before;
    particle.type = parse_type(word[1], lines_);
    particle.radius = 0.5 * parse_number(word[2], "diameter", lines_);
    particle.density = parse_number(word[3], "density", lines_);
    for (int axis = 0; axis < 3; ++axis)
      particle.position[axis] = parse_number(word[4 + axis], "a coordinate", lines_);
    for (std::size_t i = before + 7; i < words.count; ++i)
      (void)parse_integer(words.at[i], "an image flag", lines_);
    check_particle_row(particle, lines_);
    result_.particles.push_back(particle);
    result_.lines.push_back(lines_.number());
  }

  void index_ids() {
    if (!index_of_.empty()) return;
    check_particle_file(result_);
    index_of_.reserve(result_.particles.size());
    has_velocity_.resize(result_.particles.size());
    for (std::size_t i = 0; i < result_.particles.size(); ++i)
      index_of_.emplace(result_.particles[i].id, i);
  }

  std::size_t find(std::string_view word, const char* section) const {
    const auto found = index_of_.find(parse_integer(word, "id", lines_));
    if (found != index_of_.end()) return found->second;
    throw InputError(lines_.place(word),
                     fmt::format("a row of {} names an unknown id {}", section, in_quotes(word)),
                     fmt::format("every id of {} appears in Atoms", section));
  }

  void read_velocity(std::string_view content) {
    const Words words(content);
    if (words.count != 7) {
      throw InputError(lines_.place(), fmt::format("{} fields in a row of Velocities", words.count),
                       "id vx vy vz wx wy wz");
    }
    const std::size_t row = find(words.at[0], "Velocities");
    if (has_velocity_[row])
      throw InputError(
          lines_.place(),
          "a second row of Velocities for particle " + std::to_string(result_.particles[row].id),
          "every id appears once");
    has_velocity_[row] = true;
    ParticleData& particle = result_.particles[row];
    for (int axis = 0; axis < 3; ++axis) {
      particle.velocity[axis] =
          parse_number(words.at[static_cast<std::size_t>(1 + axis)], "a velocity", lines_);
      particle.omega[axis] =
          parse_number(words.at[static_cast<std::size_t>(4 + axis)], "an angular velocity", lines_);
    }
  }

  void read_bond(std::string_view content, std::string_view line) {
    const Words words(content);
    if (words.count != 4) {
      throw InputError(lines_.place(), fmt::format("{} fields in a row of Bonds", words.count),
                       "bond type id id");
    }
    (void)parse_integer(words.at[0], "bond", lines_);
    BondData bond;
    bond.law = parse_type(words.at[1], lines_);
    bond.id_a = result_.particles[find(words.at[2], "Bonds")].id;
    bond.id_b = result_.particles[find(words.at[3], "Bonds")].id;
    read_bond_state(comment_of(line), bond);
    check_bond_row(bond, lines_);
    result_.bonds.push_back(bond);
  }

  /// `length L shear x y z bending x y z twisting t`, as the writer leaves it in a comment.
  void read_bond_state(std::string_view comment, BondData& bond) const {
    std::string_view rest = comment;
    if (take_word(rest) != "length") return;
    const auto number = [&] {
      return parse_number(take_word(rest), "the state of a bond", lines_);
    };
    const auto expect = [&](std::string_view word) {
      if (take_word(rest) == word) return;
      throw InputError(lines_.place(comment), "the state of a bond is damaged",
                       "length L shear x y z bending x y z twisting t, or no comment");
    };
    bond.length = number();
    expect("shear");
    for (int c = 0; c < 3; ++c) bond.shear[c] = number();
    expect("bending");
    for (int c = 0; c < 3; ++c) bond.bending[c] = number();
    expect("twisting");
    bond.twisting = number();
  }

  void finish() {
    const SourcePlace place{result_.file, 0, 0};
    if (!has(Section::Atoms))
      throw InputError(place, "has no Atoms section",
                       "Atoms # sphere: " + std::string(lammps_row(LammpsStyle::Sphere)));
    if (!(has_bounds_[0] && has_bounds_[1] && has_bounds_[2])) {
      throw InputError(place, "the box is incomplete",
                       "the header gives xlo xhi, ylo yhi and zlo zhi");
    }
    if (style_ == LammpsStyle::BpmSphere && has_bond_count_) result_.has_bonds = true;
    check_particle_file(result_);
    check_bonds(result_, result_.bonds, result_.file);
    compare_count(std::ssize(result_.particles), num_atoms_, "Atoms");
    compare_count(std::ssize(result_.bonds), num_bonds_, "Bonds");
    if (has(Section::Velocities))
      compare_count(std::ranges::count(has_velocity_, true), num_atoms_, "Velocities");
    if (!skipped_.empty())
      result_.notes.push_back(fmt::format("sections not used: {}", fmt::join(skipped_, ", ")));
  }

  void compare_count(std::int64_t found, std::int64_t announced, const char* section) const {
    if (announced == found) return;
    throw InputError(SourcePlace{result_.file, 0, 0}, fmt::format("{} rows in {}", found, section),
                     fmt::format("the header announces {}", announced));
  }

  [[nodiscard]] bool has(Section section) const {
    return is_there_[static_cast<std::size_t>(section)];
  }

  LineReader lines_;
  ParticleFile result_;
  Section section_ = Section::Header;
  LammpsStyle style_ = LammpsStyle::Sphere;
  std::int64_t num_atoms_ = 0, num_bonds_ = 0;
  bool has_bond_count_ = false;
  std::array<bool, 5> is_there_{};  ///< sections
  std::array<bool, 3> has_bounds_{};
  std::vector<std::string_view> skipped_;
  std::unordered_map<std::int64_t, std::size_t> index_of_;
  std::vector<bool> has_velocity_;
};

}  // namespace

ParticleFile parse_particles_lammps(std::string_view text, const std::string& file) {
  const PlainText plain(text, file);
  return DataFile(plain.view(), file).read();
}

}  // namespace barchan

#include <barchan/core/io/lammps_words.hpp>

#include <algorithm>
#include <cctype>
#include <initializer_list>

#include <barchan/core/io/text_file.hpp>

namespace barchan {
namespace {

using enum LammpsSection;

constexpr std::array<LammpsSectionRule, 26> kSections = {{{"Atoms", Atoms},
                                                          {"Velocities", Velocities},
                                                          {"Bonds", Bonds},
                                                          {"Masses", Skipped},
                                                          {"Pair Coeffs", Skipped},
                                                          {"PairIJ Coeffs", Skipped},
                                                          {"Bond Coeffs", Skipped},
                                                          {"Angle Coeffs", Skipped},
                                                          {"Dihedral Coeffs", Skipped},
                                                          {"Improper Coeffs", Skipped},
                                                          {"BondBond Coeffs", Skipped},
                                                          {"BondAngle Coeffs", Skipped},
                                                          {"MiddleBondTorsion Coeffs", Skipped},
                                                          {"EndBondTorsion Coeffs", Skipped},
                                                          {"AngleTorsion Coeffs", Skipped},
                                                          {"AngleAngleTorsion Coeffs", Skipped},
                                                          {"BondBond13 Coeffs", Skipped},
                                                          {"AngleAngle Coeffs", Skipped},
                                                          {"Angles", Skipped},
                                                          {"Dihedrals", Skipped},
                                                          {"Impropers", Skipped},
                                                          {"Atom Type Labels", Skipped},
                                                          {"Bond Type Labels", Skipped},
                                                          {"Angle Type Labels", Skipped},
                                                          {"Dihedral Type Labels", Skipped},
                                                          {"Improper Type Labels", Skipped}}};

constexpr std::array<LammpsStyleRule, 3> kStyles = {{{"sphere", LammpsStyle::Sphere},
                                                     {"granular", LammpsStyle::Sphere},
                                                     {"bpm/sphere", LammpsStyle::BpmSphere}}};

constexpr std::array<std::string_view, 9> kCounted = {"atoms",     "bonds",     "angles",
                                                      "dihedrals", "impropers", "ellipsoids",
                                                      "lines",     "triangles", "bodies"};
constexpr std::array<std::string_view, 5> kTyped = {"atom", "bond", "angle", "dihedral",
                                                    "improper"};

bool is_one_of(std::string_view word, std::span<const std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

std::string_view without_comment(std::string_view line) {
  return trimmed(line.substr(0, line.find('#')));
}

std::string_view comment_of(std::string_view line) {
  const std::size_t hash = line.find('#');
  return hash == std::string_view::npos ? line.substr(line.size()) : line.substr(hash + 1);
}

LammpsWords::LammpsWords(std::string_view content) {
  for (std::string_view word = take_word(content); !word.empty() && count < at.size();
       word = take_word(content)) {
    at[count++] = word;
  }
}

bool LammpsWords::ends_with(std::initializer_list<std::string_view> tail) const {
  return count >= tail.size() &&
         std::equal(tail.begin(), tail.end(),
                    at.begin() + static_cast<std::ptrdiff_t>(count - tail.size()));
}

const LammpsSectionRule* find_lammps_section(std::string_view name) {
  const auto found = std::find_if(kSections.begin(), kSections.end(),
                                  [&](const LammpsSectionRule& rule) { return rule.name == name; });
  return found == kSections.end() ? nullptr : &*found;
}

bool is_lammps_count(const LammpsWords& words) {
  if (words.count == 2) return is_one_of(words.at[1], kCounted);
  if (words.count == 3) return words.at[2] == "types" && is_one_of(words.at[1], kTyped);
  const bool is_extra =
      words.count == 5 && words.at[1] == "extra" && words.ends_with({"per", "atom"});
  return is_extra && (words.at[2] == "special" || is_one_of(words.at[2], kTyped));
}

bool is_lammps_header_line(const LammpsWords& words) {
  if (words.count == 0) return false;
  const char first = words.at[0].front();
  const bool begins_with_number =
      std::isdigit(static_cast<unsigned char>(first)) != 0 || first == '-' || first == '.';
  if (!begins_with_number) return words.count == 1 && words.at[0] == "Atoms";
  return is_lammps_count(words) || words.ends_with({"xlo", "xhi"}) ||
         words.ends_with({"ylo", "yhi"}) || words.ends_with({"zlo", "zhi"});
}

std::span<const LammpsStyleRule> lammps_styles() {
  return kStyles;
}

std::string_view lammps_row(LammpsStyle style) {
  return style == LammpsStyle::Sphere
             ? "id type diameter density x y z, optionally three image flags"
             : "id molecule type diameter density x y z, optionally three image flags";
}

}  // namespace barchan

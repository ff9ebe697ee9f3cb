#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

// The words of LAMMPS data files, and what becomes of them here.

namespace barchan {

/// What is before a line's #, and what is behind it.
[[nodiscard]] std::string_view without_comment(std::string_view line);
[[nodiscard]] std::string_view comment_of(std::string_view line);

/// Words of a line; more than the longest row has are counted as one too many.
struct LammpsWords {
  std::array<std::string_view, 12> at{};
  std::size_t count = 0;

  explicit LammpsWords(std::string_view content);
  [[nodiscard]] bool ends_with(std::initializer_list<std::string_view> tail) const;
};

enum class LammpsSection { Header, Atoms, Velocities, Bonds, Skipped };

/// What to do with a section of that name; none where it is not known, or says what would be lost.
struct LammpsSectionRule {
  std::string_view name;
  LammpsSection kind;
};
[[nodiscard]] const LammpsSectionRule* find_lammps_section(std::string_view name);

/// Is it a count of the header, such as `12 bond types`, that needs no more than to be a number?
[[nodiscard]] bool is_lammps_count(const LammpsWords& words);

/// Could this be a line of the header? A file may lack its title line.
[[nodiscard]] bool is_lammps_header_line(const LammpsWords& words);

/// Atom styles whose rows hold diameters and densities.
enum class LammpsStyle { Sphere, BpmSphere };
struct LammpsStyleRule {
  std::string_view name;
  LammpsStyle style;
};
[[nodiscard]] std::span<const LammpsStyleRule> lammps_styles();

/// The columns of a row of Atoms, for messages.
[[nodiscard]] std::string_view lammps_row(LammpsStyle style);

}  // namespace barchan

#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

// Snapshots that ParaView and OVITO open: a `.vtp` is the piece of one rank, a `.pvtp` names the
// pieces of one time, a `.pvd` names the times. Arrays are inline base64 without compression (VTK
// "binary"), since OVITO reads no appended data; only Float64, Int64 and Int32 are used, since it
// reads few others.

namespace barchan {

/// Numbers of one array, particle by particle, components next to each other.
using VtpValues = std::variant<std::span<const double>, std::span<const std::int64_t>,
                               std::span<const std::int32_t>>;

struct VtpField {
  std::string name;
  int components = 1;
  VtpValues values;  ///< components·num_points numbers
};

/// What a snapshot holds, in the caller's memory. barchan writes: id (Int64), type (Int32, from 1),
/// radius, density, velocity (3), angular_velocity (3), rank (Int32), and whatever else is named.
/// Points are particles, or, two by two, the ends of lines: then the fields are those of the lines.
struct VtpArrays {
  std::int64_t step = 0;
  double time = 0.0;               ///< [s]
  std::span<const double> points;  ///< x y z of every particle [m]
  std::vector<VtpField> fields;
  bool are_lines = false;
};

/// A snapshot that has been read.
struct VtpColumn {
  std::string name;
  int components = 1;
  std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::int32_t>> values;
};
struct VtpPiece {
  std::int64_t step = 0;
  double time = 0.0;               ///< [s]
  std::vector<double> points;      ///< x y z of every particle, or of both ends of every line [m]
  std::vector<VtpColumn> columns;  ///< of particles or lines
  bool are_lines = false;

  /// The column of that name, null when there is none.
  [[nodiscard]] const VtpColumn* find(std::string_view name) const;
};

struct PvdEntry {
  double time = 0.0;  ///< [s]
  std::string file;   ///< relative to the .pvd
  int part = 0;       ///< of that time: particles first, then bonds
};

/// Each writes a whole file that appears under its name only when complete (temporary name,
/// rename).
/// @throws RunError; std::logic_error when a field's length does not fit
void write_vtp(const std::string& path, const VtpArrays& arrays);

/// @param pieces  paths of the .vtp files, relative to this file, in rank order
/// @param arrays  any piece's arrays: only names, types and components are used
void write_pvtp(const std::string& path, std::span<const std::string> pieces,
                const VtpArrays& arrays);
void write_pvd(const std::string& path, std::span<const PvdEntry> entries);

/// Reads back what write_vtp wrote. @throws InputError with line, for anything else
[[nodiscard]] VtpPiece read_vtp(const std::string& path);
[[nodiscard]] VtpPiece parse_vtp(std::string_view text, const std::string& file);

/// Paths of the pieces of a .pvtp, joined to its folder. @throws InputError
[[nodiscard]] std::vector<std::string> read_pvtp(const std::string& path);
[[nodiscard]] std::vector<std::string> parse_pvtp(std::string_view text, const std::string& path);

/// Entries of a .pvd, so that a restarted run can go on with it. @throws InputError
[[nodiscard]] std::vector<PvdEntry> read_pvd(const std::string& path);
[[nodiscard]] std::vector<PvdEntry> parse_pvd(std::string_view text, const std::string& file);

}  // namespace barchan

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include <barchan/core/io/vtp.hpp>
#include <barchan/core/model/model.hpp>

namespace barchan {

/// What files have of a particle: one to three columns of a table, and an array of a snapshot.
struct FileField {
  std::string_view array;                   ///< empty: the points themselves
  std::array<std::string_view, 3> columns;  ///< one, or one a component
  std::variant<std::int64_t ParticleData::*, std::int32_t ParticleData::*, double ParticleData::*,
               Vec3 ParticleData::*>
      value;
  bool is_required = true;                    ///< in a table; of a vector x and y
  std::array<std::string_view, 6> aliases{};  ///< as other programs call it, see ColumnAlias

  bool may_lack = false;  ///< not written where no particle has it, which is then not a number

  [[nodiscard]] constexpr int num_components() const { return value.index() == 3 ? 3 : 1; }
};

/// In the order of tables. Types count from 1 in files.
inline constexpr std::array kFileFields{
    FileField{
        "id", {"id"}, &ParticleData::id, true, {"particleid", "particleidentifier", "atomid"}},
    FileField{"type", {"type"}, &ParticleData::type, true, {"particletype", "atomtype"}},
    FileField{"radius", {"radius"}, &ParticleData::radius, true, {"particleradius"}},
    FileField{"density", {"density"}, &ParticleData::density, true, {"particledensity"}},
    FileField{"",
              {"x", "y", "z"},
              &ParticleData::position,
              true,
              {"position", "pos", "points", "point", "coordinates", "coord"}},
    FileField{
        "velocity", {"vx", "vy", "vz"}, &ParticleData::velocity, false, {"v", "velocity", "vel"}},
    FileField{"angular_velocity",
              {"omegax", "omegay", "omegaz"},
              &ParticleData::omega,
              false,
              {"omega", "angularvelocity", "angvel", "w"}},
    FileField{"temperature", {"temperature"}, &ParticleData::temperature, false, {"temp"}, true},
};

/// Whether any has a temperature.
[[nodiscard]] bool have_heat(std::span<const ParticleData> particles);

/// Particles as the arrays of a snapshot.
class ParticleArrays {
 public:
  /// @param has_heat  particles have temperatures
  explicit ParticleArrays(bool has_heat);
  void add(const ParticleData& particle);
  /// Of this object, which lives longer.
  [[nodiscard]] VtpArrays arrays(std::int64_t step, double time) const;

 private:
  using Values =
      std::variant<std::vector<std::int64_t>, std::vector<std::int32_t>, std::vector<double>>;
  bool has_heat_;
  std::array<Values, kFileFields.size()> values_;
};

}  // namespace barchan

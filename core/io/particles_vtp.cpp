#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/particle_columns.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/text_file.hpp>
#include <barchan/core/io/vtp.hpp>

namespace barchan {
namespace {

std::string needed_arrays() {
  std::string names;
  for (const FileField& field : kFileFields) {
    if (!field.array.empty() && !field.may_lack)
      names += (names.empty() ? "" : ", ") + std::string(field.array);
  }
  return names + " are needed";
}

template <class Number>
const std::vector<Number>& values_of(const VtpPiece& piece, const FileField& field,
                                     const std::string& file) {
  if constexpr (std::is_same_v<Number, double>)
    if (field.array.empty()) return piece.points;
  const VtpColumn* column = piece.find(field.array);
  const auto* values =
      column == nullptr ? nullptr : std::get_if<std::vector<Number>>(&column->values);
  if (values == nullptr || column->components != field.num_components()) {
    throw InputError(SourcePlace{file, 0, 0},
                     fmt::format("has no array '{}' of the expected type", field.array),
                     needed_arrays());
  }
  return *values;
}

/// Numbers of an array that holds this member.
template <class T>
using NumberOf = std::conditional_t<std::is_same_v<T, Vec3>, double, T>;

void append_piece(ParticleFile& result, const VtpPiece& piece, const std::string& file) {
  if (piece.are_lines)
    throw InputError(SourcePlace{file, 0, 0}, "holds bonds, not particles",
                     "give the file of the particles, whose name lacks _bonds");
  std::vector<ParticleData> particles(piece.points.size() / 3);
  for (const FileField& field : kFileFields) {
    if (field.may_lack && piece.find(field.array) == nullptr) continue;
    std::visit(
        [&]<class T>(T ParticleData::*member) {
          const auto& values = values_of<NumberOf<T>>(piece, field, file);
          for (std::size_t i = 0; i < particles.size(); ++i) {
            T& value = particles[i].*member;
            if constexpr (std::is_same_v<T, Vec3>)
              value = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
            else if constexpr (std::is_same_v<T, std::int32_t>)
              value = values[i] > 0 ? values[i] - 1 : -1;
            else
              value = values[i];
          }
        },
        field.value);
  }
  const LineReader lines({}, file);
  for (const ParticleData& particle : particles) {
    check_particle_row(particle, lines);
    if (!(particle.position.allFinite() && particle.velocity.allFinite() &&
          particle.omega.allFinite())) {
      throw InputError(lines.place(), "particle " + std::to_string(particle.id) + " is not finite",
                       "the file is damaged");
    }
    result.particles.push_back(particle);
    result.lines.push_back(0);
  }
}

}  // namespace

ParticleFile parse_particles_vtp(std::string_view text, const std::string& file) {
  ParticleFile result;
  result.file = file;
  append_piece(result, parse_vtp(text, file), file);
  return result;
}

bool have_heat(std::span<const ParticleData> particles) {
  return std::ranges::any_of(particles,
                             [](const ParticleData& p) { return !std::isnan(p.temperature); });
}

ParticleArrays::ParticleArrays(bool has_heat) : has_heat_(has_heat) {
  for (std::size_t f = 0; f < kFileFields.size(); ++f) {
    std::visit([&]<class T>(T ParticleData::*) { values_[f] = std::vector<NumberOf<T>>(); },
               kFileFields[f].value);
  }
}

void ParticleArrays::add(const ParticleData& particle) {
  for (std::size_t f = 0; f < kFileFields.size(); ++f) {
    std::visit(
        [&]<class T>(T ParticleData::*member) {
          const T& value = particle.*member;
          auto& values = std::get<std::vector<NumberOf<T>>>(values_[f]);
          if constexpr (std::is_same_v<T, Vec3>)
            values.insert(values.end(), {value.x(), value.y(), value.z()});
          else
            values.push_back(std::is_same_v<T, std::int32_t> ? value + T{1} : value);
        },
        kFileFields[f].value);
  }
}

VtpArrays ParticleArrays::arrays(std::int64_t step, double time) const {
  VtpArrays arrays{step, time, {}, {}};
  for (std::size_t f = 0; f < kFileFields.size(); ++f) {
    const FileField& field = kFileFields[f];
    if (field.may_lack && !has_heat_) continue;
    if (field.array.empty()) {
      arrays.points = std::get<std::vector<double>>(values_[f]);
      continue;
    }
    std::visit(
        [&]<class T>(const std::vector<T>& values) {
          arrays.fields.push_back(
              {std::string(field.array), field.num_components(), std::span<const T>(values)});
        },
        values_[f]);
  }
  return arrays;
}

void write_particles_vtp(const std::string& path, std::span<const ParticleData> particles) {
  ParticleArrays arrays(have_heat(particles));
  for (const ParticleData& p : particles) arrays.add(p);
  write_vtp(path, arrays.arrays(0, 0.0));
}

}  // namespace barchan

#include <barchan/core/io/bond_lines.hpp>

#include <algorithm>

#include <barchan/core/base/error.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/text_file.hpp>

namespace barchan {
namespace {

template <class Number>
const std::vector<Number>& values_of(const VtpPiece& piece, const char* name, int components,
                                     const std::string& file) {
  const VtpColumn* column = piece.find(name);
  const auto* values =
      column == nullptr ? nullptr : std::get_if<std::vector<Number>>(&column->values);
  if (values == nullptr || column->components != components) {
    throw InputError(SourcePlace{file, 0, 0},
                     "has no array " + in_quotes(name) + " of the expected type",
                     "bonds need id_a, id_b, type, length, shear_force, bending_moment and "
                     "twisting_moment");
  }
  return *values;
}

void append(std::vector<double>& to, const Vec3& v) {
  to.insert(to.end(), {v.x(), v.y(), v.z()});
}

Vec3 row_of(const std::vector<double>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

}  // namespace

void BondLines::add(const BondData& bond, const Vec3& a, const Vec3& b) {
  append(points_, a);
  append(points_, b);
  id_a_.push_back(bond.id_a);
  id_b_.push_back(bond.id_b);
  type_.push_back(bond.law + 1);
  length_.push_back(bond.length);
  append(shear_, bond.shear);
  append(bending_, bond.bending);
  twisting_.push_back(bond.twisting);
}

VtpArrays BondLines::arrays(std::int64_t step, double time) const {
  using Ids = std::span<const std::int64_t>;
  using Reals = std::span<const double>;
  VtpArrays arrays{step, time, points_, {}, true};
  arrays.fields = {{"id_a", 1, Ids(id_a_)},
                   {"id_b", 1, Ids(id_b_)},
                   {"type", 1, std::span<const std::int32_t>(type_)},
                   {"length", 1, Reals(length_)},
                   {"shear_force", 3, Reals(shear_)},
                   {"bending_moment", 3, Reals(bending_)},
                   {"twisting_moment", 1, Reals(twisting_)}};
  return arrays;
}

std::vector<BondData> parse_bonds_vtp(std::string_view text, const std::string& file) {
  const VtpPiece piece = parse_vtp(text, file);
  if (piece.points.empty()) return {};
  if (!piece.are_lines)
    throw InputError(SourcePlace{file, 0, 0}, "holds particles, not bonds",
                     "barchan writes bonds as lines");
  const auto& id_a = values_of<std::int64_t>(piece, "id_a", 1, file);
  const auto& id_b = values_of<std::int64_t>(piece, "id_b", 1, file);
  const auto& type = values_of<std::int32_t>(piece, "type", 1, file);
  const auto& length = values_of<double>(piece, "length", 1, file);
  const auto& shear = values_of<double>(piece, "shear_force", 3, file);
  const auto& bending = values_of<double>(piece, "bending_moment", 3, file);
  const auto& twisting = values_of<double>(piece, "twisting_moment", 1, file);
  const LineReader lines({}, file);
  std::vector<BondData> bonds;
  for (std::size_t i = 0; i < id_a.size(); ++i) {
    bonds.push_back({id_a[i], id_b[i], type[i] > 0 ? type[i] - 1 : -1, length[i], row_of(shear, i),
                     row_of(bending, i), twisting[i]});
    check_bond_row(bonds.back(), lines);
  }
  return bonds;
}

void write_bonds_vtp(const std::string& path, std::span<const ParticleData> particles,
                     std::span<const BondData> bonds) {
  std::vector<const ParticleData*> by_id;
  for (const ParticleData& p : particles) by_id.push_back(&p);
  std::sort(by_id.begin(), by_id.end(),
            [](const ParticleData* a, const ParticleData* b) { return a->id < b->id; });
  const auto position = [&](std::int64_t id) {
    const auto at =
        std::lower_bound(by_id.begin(), by_id.end(), id,
                         [](const ParticleData* p, std::int64_t wanted) { return p->id < wanted; });
    return (*at)->position;
  };
  BondLines lines;
  for (const BondData& bond : bonds) lines.add(bond, position(bond.id_a), position(bond.id_b));
  write_vtp(path, lines.arrays(0, 0.0));
}

}  // namespace barchan

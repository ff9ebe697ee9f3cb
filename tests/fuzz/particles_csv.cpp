#include <barchan/core/io/gzip.hpp>
#include <barchan/core/io/particle_file.hpp>

#include "support/input.hpp"

// Tables of particles, packed or not; one that begins with `id_a` is a table of bonds.

namespace barchan::fuzz {
namespace {

void read(std::string_view text) {
  if (is_gzip(text)) return read(unzipped(text, "particles.csv.gz"));
  if (text.starts_with("id_a")) return (void)parse_bonds_csv(text, "particles_bonds.csv");
  ParticleFile file = parse_particles_csv(text, "particles.csv");
  convert_to_areal_density(file);
}

}  // namespace
}  // namespace barchan::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace barchan::fuzz;
  expect_input_error([&] { read(text_of(data, size)); });
  return 0;
}

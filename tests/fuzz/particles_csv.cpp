#include <barchan/core/io/particle_file.hpp>

#include "support/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace barchan;
  fuzz::expect_input_error([&] {
    ParticleFile file = parse_particles_csv(fuzz::text_of(data, size), "particles.csv");
    convert_to_areal_density(file);
  });
  return 0;
}

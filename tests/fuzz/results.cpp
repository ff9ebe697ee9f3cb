#include <barchan/app/readable.hpp>
#include <barchan/app/run_view.hpp>
#include <barchan/core/io/particle_file.hpp>
#include <barchan/core/io/series.hpp>
#include <barchan/core/io/vtp.hpp>

#include "support/input.hpp"

// The files of a run that are read again: snapshots (.vtp, .pvtp, .pvd) and what `barchan info` and
// a restart read of series.csv and run.json. The first byte says which.

namespace barchan::fuzz {
namespace {

void read(std::uint8_t kind, std::string_view text) {
  if (kind == 'v') {
    (void)parse_particles_vtp(text, "piece.vtp");
  } else if (kind == 'b') {
    (void)parse_bonds_vtp(text, "piece_bonds.vtp");
  } else if (kind == 'p') {
    (void)parse_pvtp(text, "folder/whole.pvtp");
  } else if (kind == 'd') {
    (void)parse_pvd(text, "run.pvd");
  } else if (kind == 's') {
    if (app::is_series(text)) (void)app::table(app::series_rows(text, "series.csv"), 2);
    const std::string header(text.substr(0, text.find('\n')));
    (void)kept_rows(text, "series.csv", header, 100);
  } else {
    (void)app::table(app::run_rows(text, "run.json"), 2);
  }
}

}  // namespace
}  // namespace barchan::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace barchan::fuzz;
  if (size == 0) return 0;
  expect_input_error([&] { read(data[0], text_of(data + 1, size - 1)); });
  return 0;
}

// Fields of the caller's own in barchan.h.
#include <string>

#include "arrays.hpp"

namespace {

using barchan::Simulation;
using barchan::c::list_of;
using barchan::c::require;
using barchan::c::with;

constexpr const char* kNoName = "the name of the field is NULL";

}  // namespace

extern "C" {

int barchan_add_field(barchan_sim* sim, const char* name, int components) {
  return with(sim, [&](Simulation& s) {
    require(name != nullptr, kNoName);
    (void)s.add_field(name, components);
  });
}

int barchan_get_field(barchan_sim* sim, int brick, const char* name, barchan_values* values) {
  return with(sim, [&](Simulation& s) {
    require(name != nullptr, kNoName);
    barchan::c::give(barchan::c::brick_of(s.field(name), brick).values(), values);
  });
}

int barchan_gather_field(barchan_sim* sim, const char* name, int64_t room, int64_t* ids,
                         double* values, int64_t* count) {
  return with(sim, [&](Simulation& s) {
    require(name != nullptr, kNoName);
    barchan::c::give(s, s.gather(std::string(name)), {room, ids, values, count});
  });
}

int barchan_scatter_field(barchan_sim* sim, const char* name, int64_t count, const int64_t* ids,
                          const double* values) {
  return with(sim, [&](Simulation& s) {
    require(name != nullptr, kNoName);
    std::int64_t components = 0;  // of a field that there is not
    for (const barchan::CallerField& field : s.fields())
      if (field.name == name) components = field.components;
    s.scatter(std::string(name), list_of(ids, count, "barchan_scatter_field: ids are NULL"),
              list_of(values, components * count, "barchan_scatter_field: values are NULL"));
  });
}

}  // extern "C"

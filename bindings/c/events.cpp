// Callbacks of barchan.h.
#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "arrays.hpp"

/// What a callback sees of a brick.
struct barchan_brick {
  const barchan::ParticleView* view;
};

namespace {

using barchan::Simulation;
using barchan::c::require;
using barchan::c::with;

void judge(int value) {
  if (value != 0) throw std::runtime_error("the callback returned " + std::to_string(value));
}

template <class Work>
int of_brick(const barchan_brick* brick, Work&& work) {
  return barchan::c::guarded([&] {
    require(brick != nullptr, "the brick is NULL");
    work(*brick->view);
  });
}

std::vector<barchan_departure> plain(std::span<const barchan::Departure> all) {
  std::vector<barchan_departure> left;
  for (const barchan::Departure& from : all) {
    barchan_departure& to = left.emplace_back();
    to.step = from.step;
    to.id = from.id;
    std::copy_n(from.position, 3, to.position);
    std::copy_n(from.velocity, 3, to.velocity);
  }
  return left;
}

}  // namespace

extern "C" {

int barchan_on_step(barchan_sim* sim, int64_t every,
                    int (*visit)(void* user, const barchan_brick* brick), void* user) {
  return with(sim, [&](Simulation& s) {
    if (visit == nullptr) return s.on_step(every, {});
    s.on_step(every, [=](const barchan::ParticleView& view) {
      const barchan_brick brick{&view};
      judge(visit(user, &brick));
    });
  });
}

int barchan_on_progress(barchan_sim* sim, int64_t every,
                        int (*tell)(void* user, int64_t step, double time), void* user) {
  return with(sim, [&](Simulation& s) {
    if (tell == nullptr) return s.on_progress(every, {});
    s.on_progress(every,
                  [=](const barchan::RunProgress& now) { judge(tell(user, now.step, now.time)); });
  });
}

int barchan_on_note(barchan_sim* sim, int (*tell)(void* user, const char* text, int is_warning),
                    void* user) {
  return with(sim, [&](Simulation& s) {
    if (tell == nullptr) return s.on_note({});
    s.on_note([=](const barchan::Note& note) {
      judge(tell(user, note.text.c_str(), note.is_warning ? 1 : 0));
    });
  });
}

int barchan_on_checkpoint(barchan_sim* sim,
                          int (*tell)(void* user, int64_t step, const char* folder,
                                      const char* error),
                          void* user) {
  return with(sim, [&](Simulation& s) {
    if (tell == nullptr) return s.on_checkpoint({});
    s.on_checkpoint([=](const barchan::CheckpointEvent& event) {
      judge(tell(user, event.step, event.folder.c_str(), event.error.c_str()));
    });
  });
}

int barchan_on_bond_breaks(barchan_sim* sim,
                           int (*tell)(void* user, int64_t count, const barchan_bond_break* breaks),
                           void* user) {
  return with(sim, [&](Simulation& s) {
    if (tell == nullptr) return s.on_bond_breaks({});
    s.on_bond_breaks([=](std::span<const barchan::BondBreak> all) {
      std::vector<barchan_bond_break> breaks;
      for (const barchan::BondBreak& b : all) breaks.push_back({b.step, b.id_a, b.id_b});
      judge(tell(user, static_cast<int64_t>(breaks.size()), breaks.data()));
    });
  });
}

int barchan_on_departure(barchan_sim* sim,
                         int (*tell)(void* user, int64_t count, const barchan_departure* left),
                         void* user) {
  return with(sim, [&](Simulation& s) {
    if (tell == nullptr) return s.on_departure({});
    s.on_departure([=](std::span<const barchan::Departure> all) {
      const std::vector<barchan_departure> left = plain(all);
      judge(tell(user, static_cast<int64_t>(left.size()), left.data()));
    });
  });
}

int barchan_brick_view(const barchan_brick* brick, int field, barchan_view* view) {
  return of_brick(brick, [&](const auto& of) { barchan::c::give(of, field, view); });
}

int barchan_brick_ids(const barchan_brick* brick, const int64_t** ids, int64_t* size) {
  return of_brick(brick, [&](const auto& of) { barchan::c::give(of.ids(), ids, size); });
}

int barchan_brick_types(const barchan_brick* brick, const uint8_t** types, int64_t* size) {
  return of_brick(brick, [&](const auto& of) { barchan::c::give(of.types(), types, size); });
}

int barchan_brick_loads(const barchan_brick* brick, barchan_loads* loads) {
  return of_brick(brick, [&](const auto& of) { barchan::c::give(of.loads(), loads); });
}

int barchan_brick_field(const barchan_brick* brick, const char* name, barchan_values* values) {
  return of_brick(brick, [&](const auto& of) {
    require(name != nullptr, "the name of the field is NULL");
    barchan::c::give(of.field(name), values);
  });
}

}  // extern "C"

#pragma once

// What tests of calls between steps share: texts of errors, a gas with a caller's drag, and a
// course that must be the same on any ranks and threads.

#include <gtest/gtest.h>
#include <mpi.h>

#include <string>

#include "law_scenarios.hpp"
#include "running.hpp"

namespace barchan::test {

template <class Error, class Call>
std::string words_thrown(Call&& call) {
  try {
    call();
  } catch (const Error& e) {
    return e.what();
  }
  return "no such error";
}

inline void expect_words(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' in '" << text << "'";
}

inline Vec3 drag(double vx, double vy, double vz) {
  return {-2.0 * vx + 1.0, -0.5 * vy, -0.7 * vz};
}

inline Scenario dragged(int dimension) {
  Scenario s = gas(dimension, {true, false, false}, 3.0, "drag by the caller");
  s.num_steps = 160;
  return s;
}

/// @param course  calls on a Simulation: alone, and on all ranks with 1 and 2 threads
template <class CourseOfCalls>
void expect_same_on_any_ranks(const Scenario& s, CourseOfCalls&& course) {
  Simulation alone(s.model, s.set, MPI_COMM_SELF, with_threads(1));
  course(alone);
  const Words expected = words_of(alone);
  for (const int threads : {1, 2}) {
    Simulation sim(s.model, s.set, MPI_COMM_WORLD, with_threads(threads));
    course(sim);
    EXPECT_EQ(words_of(sim), expected);
  }
}

}  // namespace barchan::test

// Stands in for preCICE 3 where it is not installed: those calls of its Participant that the
// example makes, with a partner inside. The partner is a spring that presses the wall down and is
// pushed back, without mass:
//
//     u = −(kPress − |F| / kSpring)
//
// in windows that are no multiple of a step, done three times each.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

namespace precice {

using VertexID = int;
template <class T>
using span = std::span<T>;
using string_view = std::string_view;

class Participant {
 public:
  Participant(string_view name, string_view config, int /*rank*/, int size) {
    require(name == "Particles" && config.ends_with(".xml") && size > 0, "construction");
  }
  int getMeshDimensions(string_view mesh) const {
    require(mesh == "Wall-Mesh", "getMeshDimensions");
    return 2;
  }
  void setMeshVertices(string_view, span<const double> positions, span<VertexID> ids) {
    require(positions.size() == 2 * ids.size() && !has_begun_, "setMeshVertices");
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<VertexID>(i);
  }
  void initialize() { has_begun_ = true; }
  bool isCouplingOngoing() const { return window_ < kWindows; }
  double getMaxTimeStepSize() const { return kWindow; }
  bool requiresWritingCheckpoint() const { return turn_ == 0; }
  bool requiresReadingCheckpoint() const { return must_go_back_; }
  void readData(string_view, string_view data, span<const VertexID> ids, double later,
                span<double> values) const {
    require(data == "Displacement" && values.size() == 2 * ids.size(), "readData");
    values[0] = 0.0;
    values[1] = begin_ + (end_ - begin_) * later / kWindow;
  }
  void writeData(string_view, string_view data, span<const VertexID> ids,
                 span<const double> values) {
    require(data == "Force" && values.size() == 2 * ids.size(), "writeData");
    force_ = std::fabs(values[1]);
  }
  void advance(double dt) {
    require(std::fabs(dt - kWindow) < 1e-12, "advance");
    end_ -= kRelax * (end_ + kPress - force_ / kSpring);
    must_go_back_ = turn_ < 2;
    turn_ = (turn_ + 1) % 3;
    if (must_go_back_) return;
    begin_ = end_;
    ++window_;
  }
  void finalize() { require(!isCouplingOngoing(), "finalize"); }

 private:
  static constexpr int kWindows = 300;
  static constexpr double kWindow = 1.15e-3, kPress = 0.004, kSpring = 5e4;
  /// A window is so short that contacts resist by their dashpots, thirty times as stiff as the
  /// spring: turns converge only where each goes a small part of the way.
  static constexpr double kRelax = 0.02;
  static void require(bool is_right, const char* call) {
    if (!is_right) throw std::logic_error(std::string("a wrong call of ") + call);
  }

  bool has_begun_ = false, must_go_back_ = false;
  int window_ = 0, turn_ = 0;
  double begin_ = 0.0, end_ = 0.0, force_ = 0.0;
};

}  // namespace precice

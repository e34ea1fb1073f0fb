// SPDX-License-Identifier: GPL-2.0-or-later
// Every model with a geometry, the ranges of its joints and poses, and an independent judge of the reachable
// poses. every_model_test.cc tests all models in this list.
#pragma once

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "kinematics/kinematics.hh"

namespace mw::kinematics::test {

struct Span {
    double low = 0, high = 0;
};

enum class Verdict { REACHABLE, UNREACHABLE, UNKNOWN };

struct ModelCase {
    std::string name;
    std::shared_ptr<const Kinematics> model;
    std::string axes;          ///< letters that the joints move
    std::vector<Span> poses;   ///< range of each letter [machine units, degrees]
    std::vector<Span> joints;  ///< range of each joint; empty where random joints fit no pose (closed loops)
    std::vector<double> home;  ///< joints from which the first pose is calculated
    double size = 1;           ///< size of the machine, for tolerances [machine units]
    bool are_angles_rpy =
        false;  ///< A, B and C are one orientation: different angles may be the same orientation
    bool iterating = false;
    std::function<Verdict(const Pose &)> judge = [](const Pose &) { return Verdict::REACHABLE; };
};

/// Prints the name of the case.
inline void PrintTo(const ModelCase &one, std::ostream *out) {
    *out << one.name;
}

const std::vector<ModelCase> &all_models();

}  // namespace mw::kinematics::test

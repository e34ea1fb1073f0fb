// SPDX-License-Identifier: GPL-2.0-or-later
// Every model with a geometry, where its joints and poses are drawn from, and a judge who knows which poses
// it reaches by other means than the model. The suite of every_model_test.cc runs over this list.
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
    std::string axes;           ///< letters that the joints move
    std::vector<Span> poses;    ///< one for each of them [machine units, degrees]
    std::vector<Span> joints;   ///< one for each joint; empty where drawn joints fit no pose (closed loops)
    std::vector<double> home;   ///< joints that poses are first asked from
    double size = 1;            ///< of the machine, for tolerances [machine units]
    bool areAnglesRpy = false;  ///< A, B and C are one orientation: other angles may mean the same
    bool isIterating = false;
    std::function<Verdict(const Pose &)> judge = [](const Pose &) { return Verdict::REACHABLE; };
};

/// As tests name it.
inline void PrintTo(const ModelCase &one, std::ostream *out) {
    *out << one.name;
}

const std::vector<ModelCase> &all_models();

}  // namespace mw::kinematics::test

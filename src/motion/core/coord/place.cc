// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/core/coord/place.hh"

namespace mw::motion {

void read_feedback(Place &place, const kins::Kinematics &kinematics, const double *joints,
                   bool areAllHomed) noexcept {
    const kins::Kind kind = kinematics.kind();
    if (kind == kins::Kind::INVERSE_ONLY) {
        place.fb = place.cmd;
    }
    const bool isAsked = kind == kins::Kind::IDENTITY || (areAllHomed && kind != kins::Kind::INVERSE_ONLY);
    place.isFbValid = isAsked && isAnswered(kinematics.forward(joints, place.fb));
}

void follow_joints(Place &place, const kins::Kinematics &kinematics, const double *joints,
                   bool isKnown) noexcept {
    place.velocity = 0;
    if (kinematics.kind() == kins::Kind::IDENTITY || isKnown) {
        kinematics.forward(joints, place.cmd);
    }
}

void find_again(Place &place, const kins::Kinematics &kinematics, const double *joints,
                const geom::Pose &first) noexcept {
    geom::Pose pose = place.cmd;
    if (kinematics.kind() != kins::Kind::BOTH || isAnswered(kinematics.forward(joints, pose))) {
        return;
    }
    pose = first;
    if (isAnswered(kinematics.forward(joints, pose))) {
        place.cmd = place.fb = pose;
    }
}

void follow_pose(Place &place, const geom::Pose &pose, double period_s) noexcept {
    place.velocity = geom::norm_xyz(pose - place.cmd) / period_s;
    place.cmd = pose;
}

void fill(const Place &place, Status &status) noexcept {
    status.isCartePosValid = place.isFbValid;
    status.carte_pos_cmd = place.cmd;
    status.carte_pos_fb = place.fb;
}

}  // namespace mw::motion

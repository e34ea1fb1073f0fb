// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/coord/cartesian_position.hh"

namespace mw::motion {

void read_feedback(CartesianPosition &place, const kinematics::Kinematics &kinematics, const double *joints,
                   bool areAllHomed) noexcept {
    const kinematics::Kind kind = kinematics.kind();
    if (kind == kinematics::Kind::INVERSE_ONLY) {
        place.fb = place.cmd;
    }
    const bool isAsked =
        kind == kinematics::Kind::IDENTITY || (areAllHomed && kind != kinematics::Kind::INVERSE_ONLY);
    place.isFbValid = isAsked && isAnswered(kinematics.forward(joints, place.fb));
}

void follow_joints(CartesianPosition &place, const kinematics::Kinematics &kinematics, const double *joints,
                   bool isKnown) noexcept {
    place.velocity = 0;
    if (kinematics.kind() == kinematics::Kind::IDENTITY || isKnown) {
        kinematics.forward(joints, place.cmd);
    }
}

void find_again(CartesianPosition &place, const kinematics::Kinematics &kinematics, const double *joints,
                const geometry::Pose &first) noexcept {
    geometry::Pose pose = place.cmd;
    if (kinematics.kind() != kinematics::Kind::BOTH || isAnswered(kinematics.forward(joints, pose))) {
        return;
    }
    pose = first;
    if (isAnswered(kinematics.forward(joints, pose))) {
        place.cmd = place.fb = pose;
    }
}

void follow_pose(CartesianPosition &place, const geometry::Pose &pose, double period_s) noexcept {
    place.velocity = geometry::norm_xyz(pose - place.cmd) / period_s;
    place.cmd = pose;
}

void fill(const CartesianPosition &place, Status &status) noexcept {
    status.isCartePosValid = place.isFbValid;
    status.carte_pos_cmd = place.cmd;
    status.carte_pos_fb = place.fb;
}

}  // namespace mw::motion

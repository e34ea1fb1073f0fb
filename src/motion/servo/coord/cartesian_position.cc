// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/coord/cartesian_position.hh"

namespace mw::motion {

void CartesianPosition::read_feedback(const kinematics::Kinematics &kinematics, const double *joints,
                                      bool areAllHomed) noexcept {
    const kinematics::Kind kind = kinematics.kind();
    if (kind == kinematics::Kind::INVERSE_ONLY) {
        fb_ = cmd_;
    }
    const bool isAsked =
        kind == kinematics::Kind::IDENTITY || (areAllHomed && kind != kinematics::Kind::INVERSE_ONLY);
    fb_valid_ = isAsked && isAnswered(kinematics.forward(joints, fb_));
}

void CartesianPosition::follow_joints(const kinematics::Kinematics &kinematics, const double *joints,
                                      bool isKnown) noexcept {
    velocity_ = 0;
    if (kinematics.kind() == kinematics::Kind::IDENTITY || isKnown) {
        kinematics.forward(joints, cmd_);
    }
}

void CartesianPosition::find_again(const kinematics::Kinematics &kinematics, const double *joints,
                                   const geometry::Pose &first) noexcept {
    geometry::Pose pose = cmd_;
    if (kinematics.kind() != kinematics::Kind::BOTH || isAnswered(kinematics.forward(joints, pose))) {
        return;
    }
    pose = first;
    if (isAnswered(kinematics.forward(joints, pose))) {
        cmd_ = fb_ = pose;
    }
}

void CartesianPosition::follow_pose(const geometry::Pose &pose, double period_s) noexcept {
    velocity_ = geometry::norm_xyz(pose - cmd_) / period_s;
    cmd_ = pose;
}

void CartesianPosition::fill(Status &status) const noexcept {
    status.isCartePosValid = fb_valid_;
    status.carte_pos_cmd = cmd_;
    status.carte_pos_fb = fb_;
}

}  // namespace mw::motion

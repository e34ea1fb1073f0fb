// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/machine_model.hh"

namespace mw::motion {

void MachineModel::use_joints(int count) noexcept {
    config_.num_joints = count;
    map_ = axis_map(*kinematics_, count, config_.num_extra_joints);
}

Reason MachineModel::set(const SetParameter &command) noexcept {
    return settings_.set(command, config_.num_joints, config_.num_spindles);
}

void MachineModel::fold(const HomedJoints &homed) noexcept {
    map_.set_linear(map_.kind == AxisMap::Kind::PLANNED ? kinematics_->linear() : kinematics::LinearJoints{});
    limits_ = fold_limits(settings_, map_, homed);
    ++limits_version_;
}

}  // namespace mw::motion

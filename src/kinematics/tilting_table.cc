// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/tilting_table.hh"

namespace mw::kinematics {

namespace {

template <int AXIS>
Vector turned(const Vector &v, double degrees) noexcept {
    return AXIS == geometry::AXIS_A ? turned_x(v, degrees) : turned_y(v, degrees);
}

}  // namespace

/// Vector from the table's axis to the tilting axis, normal to the tilting axis.
template <int TILT>
Vector TiltingTable<TILT>::offset() const noexcept {
    const double z = get(Z_OFFSET) + get(TOOL);
    return TILT == geometry::AXIS_A ? Vector{0, get(Y_OFFSET), z} : Vector{get(X_OFFSET), 0, z};
}

template <int TILT>
Status TiltingTable<TILT>::forward(const double *joints, Pose &pose) const noexcept {
    if (!areFinite(joints, letters_.identity()->num_joints)) {
        return Status::UNREACHABLE;
    }
    Pose found = pose;
    letters_.forward(joints, found);
    const Vector level = turned<TILT>(place_of(found) - turn_point() - offset(), -found[TILT]) + offset();
    set_place(found, turned_z(level, -found[geometry::AXIS_C]) + turn_point());
    if (!isFinite(found)) {
        return Status::UNREACHABLE;
    }
    pose = found;
    return Status::OK;
}

template <int TILT>
Status TiltingTable<TILT>::inverse(const Pose &pose, double *joints) const noexcept {
    if (!isFinite(pose)) {
        return Status::UNREACHABLE;
    }
    const Vector level = turned_z(place_of(pose) - turn_point(), pose[geometry::AXIS_C]);
    Pose places = pose;
    set_place(places, turned<TILT>(level - offset(), pose[TILT]) + offset() + turn_point());
    return letters_.inverse(places, joints);
}

template class TiltingTable<geometry::AXIS_A>;
template class TiltingTable<geometry::AXIS_B>;

Status XyzabTable::forward(const double *joints, Pose &pose) const noexcept {
    if (!areFinite(joints, 5)) {
        return Status::UNREACHABLE;
    }
    const Vector tool{0, 0, get(TOOL)};
    const Vector off{0, 0, get(Z_OFFSET) + get(TOOL)};
    const Vector place{joints[0], joints[1], joints[2]};
    const Vector on_b = turned_y(place - turn_point() - tool, joints[4]) + tool;
    set_place(pose, turned_x(on_b - off, joints[3]) + off + turn_point());
    pose[geometry::AXIS_A] = joints[3];
    pose[geometry::AXIS_B] = joints[4];
    return Status::OK;
}

Status XyzabTable::inverse(const Pose &pose, double *joints) const noexcept {
    if (!isFinite(pose)) {
        return Status::UNREACHABLE;
    }
    const Vector tool{0, 0, get(TOOL)};
    const Vector off{0, 0, get(Z_OFFSET) + get(TOOL)};
    const Vector on_b = turned_x(place_of(pose) - turn_point() - off, -pose[geometry::AXIS_A]) + off;
    const Vector place = turned_y(on_b - tool, -pose[geometry::AXIS_B]) + tool + turn_point();
    joints[0] = place.x;
    joints[1] = place.y;
    joints[2] = place.z;
    joints[3] = pose[geometry::AXIS_A];
    joints[4] = pose[geometry::AXIS_B];
    return Status::OK;
}

}  // namespace mw::kinematics

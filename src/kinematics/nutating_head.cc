// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/nutating_head.hh"

namespace mw::kinematics {

namespace {

constexpr int JOINTS = 6;

template <int AXIS>
Vector turned_by_table(const Vector &v, double degrees) noexcept {
    return AXIS == geometry::AXIS_A ? turned_x(v, degrees) : turned_y(v, degrees);
}

}  // namespace

/// Position in the plane normal to the axis of the table.
template <int TABLE, const auto &ROWS>
Vector NutatingHead<TABLE, ROWS>::across(double length, double z) noexcept {
    return TABLE == geometry::AXIS_A ? Vector{0, length, z} : Vector{length, 0, z};
}

template <int TABLE, const auto &ROWS>
Vector NutatingHead<TABLE, ROWS>::leaned(const Vector &v, double degrees) const noexcept {
    const double lean = this->get(NUTATION);
    return rotation_about(across(sine(lean), cosine(lean)) * (degrees * RADIANS)) * v;
}

/// Vector from the axis C of the head to the tool tip.
template <int TABLE, const auto &ROWS>
Vector NutatingHead<TABLE, ROWS>::tip(double primary, double secondary) const noexcept {
    const Vector nose = leaned(Vector{} - pivot() - tool(), secondary);
    return turned_z(nose - offset(), primary);
}

/// Vector from the axis C of the head at home; its component along that axis is arbitrary.
template <int TABLE, const auto &ROWS>
Vector NutatingHead<TABLE, ROWS>::table_axis() const noexcept {
    return across(this->get(ACROSS_ROT), this->get(Z_ROT)) - pivot() - offset();
}

template <int TABLE, const auto &ROWS>
Status NutatingHead<TABLE, ROWS>::forward(const double *joints, Pose &pose) const noexcept {
    if (!areFinite(joints, JOINTS)) {
        return Status::UNREACHABLE;
    }
    const Vector place{joints[0], joints[1], joints[2]};
    Pose found = pose;
    for (int i = 0; i < JOINTS; ++i) {
        found[i] = joints[i];
    }
    if (frame_ == HeadFrame::TOOL) {
        const Vector off_c = turned_z(place + offset() + pivot(), -this->get(PRIMARY)) - offset();
        const Vector at_nose = leaned(off_c, -this->get(SECONDARY)) - pivot();
        set_place(found, turned_z(at_nose, -this->get(PRE_ROT) * DEGREES));
    } else {
        const Vector axis = table_axis();
        const Vector on_table = place - axis + tip(joints[geometry::AXIS_C], joints[SECOND]);
        set_place(found,
                  turned_by_table<TABLE>(on_table, joints[TABLE]) + axis + offset() + pivot() + tool());
    }
    if (!isFinite(found)) {
        return Status::UNREACHABLE;
    }
    pose = found;
    return Status::OK;
}

template <int TABLE, const auto &ROWS>
Status NutatingHead<TABLE, ROWS>::inverse(const Pose &pose, double *joints) const noexcept {
    if (!isFinite(pose)) {
        return Status::UNREACHABLE;
    }
    Vector place;
    if (frame_ == HeadFrame::TOOL) {
        const Vector at_nose = turned_z(place_of(pose), this->get(PRE_ROT) * DEGREES);
        const Vector off_c = leaned(at_nose + pivot(), this->get(SECONDARY));
        place = turned_z(off_c + offset(), this->get(PRIMARY)) - offset() - pivot();
    } else {
        const Vector axis = table_axis();
        const Vector on_table = place_of(pose) - axis - offset() - pivot() - tool();
        place =
            turned_by_table<TABLE>(on_table, -pose[TABLE]) + axis - tip(pose[geometry::AXIS_C], pose[SECOND]);
    }
    if (!isFinite(place)) {
        return Status::UNREACHABLE;
    }
    joints[0] = place.x;
    joints[1] = place.y;
    joints[2] = place.z;
    joints[3] = pose[geometry::AXIS_A];
    joints[4] = pose[geometry::AXIS_B];
    joints[5] = pose[geometry::AXIS_C];
    return Status::OK;
}

template class NutatingHead<geometry::AXIS_A, HEAD_OVER_A_PARAMETERS>;
template class NutatingHead<geometry::AXIS_B, HEAD_OVER_B_PARAMETERS>;

}  // namespace mw::kinematics

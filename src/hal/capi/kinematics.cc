// SPDX-License-Identifier: GPL-2.0-or-later
// kinematics.h: shared functions of modules with a coordinates= text.
#include "hal/include/kinematics.h"

#include <array>
#include <cstring>

#include "hal/capi/status.hh"

namespace {

constexpr int AXES = 9;
constexpr int JOINTS = 16;
constexpr const char *LETTERS = "XYZABCUVW";

/// The last mapping. The C interface has one mapping for all modules, which are set up one after the other.
struct Mapping {
    std::array<int, JOINTS> axis{};
    bool isMade = false;
};

Mapping &mapping() {
    static Mapping the_mapping;
    return the_mapping;
}

double *axis_of(EmcPose &pose, int axis) {
    const std::array<double *, AXES> all{&pose.tran.x, &pose.tran.y, &pose.tran.z, &pose.a, &pose.b,
                                         &pose.c,      &pose.u,      &pose.v,      &pose.w};
    return all[static_cast<std::size_t>(axis)];
}

}  // namespace

extern "C" {

int map_coordinates_to_jnumbers(const char *coordinates, const int max_joints, const int allow_duplicates,
                                int axis_idx_for_jno[]) {
    const char *text = coordinates == nullptr || *coordinates == '\0' ? LETTERS : coordinates;
    Mapping found;
    found.axis.fill(-1);
    std::array<bool, AXES> used{};
    int joint = 0;
    for (; *text != '\0'; ++text) {
        if (*text == ' ' || *text == '\t') {
            continue;
        }
        const char letter = static_cast<char>(*text >= 'a' && *text <= 'z' ? *text - 'a' + 'A' : *text);
        const char *place = std::strchr(LETTERS, letter);
        if (place == nullptr) {
            mw::hal::capi::complain(EINVAL, fmt::format("coordinates: '{}' is none of XYZABCUVW", *text));
            return -1;
        }
        const int axis = static_cast<int>(place - LETTERS);
        if (used[static_cast<std::size_t>(axis)] && allow_duplicates == 0) {
            mw::hal::capi::complain(EINVAL, fmt::format("coordinates: {} appears twice", letter));
            return -1;
        }
        if (joint >= max_joints || joint >= JOINTS) {
            mw::hal::capi::complain(EINVAL,
                                    fmt::format("coordinates: more letters than the {} joints", max_joints));
            return -1;
        }
        used[static_cast<std::size_t>(axis)] = true;
        found.axis[static_cast<std::size_t>(joint++)] = axis;
    }
    for (int i = 0; axis_idx_for_jno != nullptr && i < max_joints; ++i) {
        axis_idx_for_jno[i] = i < JOINTS ? found.axis[static_cast<std::size_t>(i)] : -1;
    }
    found.isMade = true;
    mapping() = found;
    return 0;
}

int mapped_joints_to_position(const int max_joints, const double *joints, EmcPose *pose) {
    const Mapping &map = mapping();
    for (int joint = max_joints < JOINTS ? max_joints - 1 : JOINTS - 1; map.isMade && joint >= 0; --joint) {
        if (const int axis = map.axis[static_cast<std::size_t>(joint)]; axis >= 0) {
            *axis_of(*pose, axis) = joints[joint];
        }
    }
    return map.isMade ? 0 : -1;
}

int position_to_mapped_joints(const int max_joints, const EmcPose *pos, double *joints) {
    const Mapping &map = mapping();
    EmcPose pose = *pos;
    for (int joint = 0; map.isMade && joint < max_joints && joint < JOINTS; ++joint) {
        if (const int axis = map.axis[static_cast<std::size_t>(joint)]; axis >= 0) {
            joints[joint] = *axis_of(pose, axis);
        }
    }
    return map.isMade ? 0 : -1;
}

int identityKinematicsSetup(const int /*comp_id*/, const char *coordinates, kparms *ksetup_parms) {
    std::array<int, JOINTS> ignored{};
    return map_coordinates_to_jnumbers(coordinates,
                                       ksetup_parms->max_joints < JOINTS ? ksetup_parms->max_joints : JOINTS,
                                       ksetup_parms->allow_duplicates, ignored.data());
}

int identityKinematicsForward(const double *joint, struct EmcPose *world, const KINEMATICS_FORWARD_FLAGS *,
                              KINEMATICS_INVERSE_FLAGS *) {
    return mapped_joints_to_position(JOINTS, joint, world);
}

int identityKinematicsInverse(const struct EmcPose *world, double *joint, const KINEMATICS_INVERSE_FLAGS *,
                              KINEMATICS_FORWARD_FLAGS *) {
    return position_to_mapped_joints(JOINTS, world, joint);
}

}  // extern "C"

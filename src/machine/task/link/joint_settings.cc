// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/link/joint_settings.hh"

#include <cmath>

#include <fmt/format.h>

namespace mw::task {
namespace {

using motion::Parameter;
using motion::SetParameter;
using Settings = std::vector<SetParameter>;

SetParameter set(Parameter parameter, int joint, double value) {
    return {static_cast<std::uint16_t>(parameter), static_cast<std::int16_t>(joint), value};
}

double flag(bool set) {
    return set ? 1 : 0;
}

}  // namespace

Settings joint_settings(const messages::SetJointMinLimit &c) {
    return {set(Parameter::JOINT_MIN_LIMIT, c.joint, c.limit)};
}

Settings joint_settings(const messages::SetJointMaxLimit &c) {
    return {set(Parameter::JOINT_MAX_LIMIT, c.joint, c.limit)};
}

Settings joint_settings(const messages::SetJointFerror &c) {
    return {set(Parameter::JOINT_FERROR, c.joint, c.ferror)};
}

Settings joint_settings(const messages::SetJointMinFerror &c) {
    return {set(Parameter::JOINT_MIN_FERROR, c.joint, c.ferror)};
}

Settings joint_settings(const messages::SetJointBacklash &c) {
    return {set(Parameter::JOINT_BACKLASH, c.joint, c.backlash)};
}

Settings joint_settings(const messages::SetJointHoming &c) {
    return {set(Parameter::JOINT_HOME, c.joint, c.home),
            set(Parameter::JOINT_HOME_OFFSET, c.joint, c.offset),
            set(Parameter::JOINT_HOME_FINAL_VEL, c.joint, c.final_velocity),
            set(Parameter::JOINT_HOME_SEARCH_VEL, c.joint, c.search_velocity),
            set(Parameter::JOINT_HOME_LATCH_VEL, c.joint, c.latch_velocity),
            set(Parameter::JOINT_HOME_USE_INDEX, c.joint, flag(c.isIndexUsed)),
            set(Parameter::JOINT_HOME_INDEX_NO_ENCODER_RESET, c.joint, flag(!c.isEncoderReset)),
            set(Parameter::JOINT_HOME_IGNORE_LIMITS, c.joint, flag(c.isLimitIgnored)),
            set(Parameter::JOINT_HOME_IS_SHARED, c.joint, flag(c.isShared)),
            set(Parameter::JOINT_HOME_SEQUENCE, c.joint, c.sequence),
            set(Parameter::JOINT_VOLATILE_HOME, c.joint, flag(c.isVolatile)),
            set(Parameter::JOINT_LOCKING_INDEXER, c.joint, flag(c.isLocking)),
            set(Parameter::JOINT_HOME_ABSOLUTE_ENCODER, c.joint, c.absolute_encoder)};
}

Result<> check_settings(const Settings &changes, const motion::Settings &current, const JointsNow &joints) {
    if (joints.homing) {
        return fail("not possible while joints are homing");
    }
    motion::Settings after = current;
    for (const SetParameter &change : changes) {
        const motion::ParameterInfo &info = motion::PARAMETERS[change.parameter];
        const motion::Reason reason = after.set(change, joints.count, MAX_SPINDLES);
        if (reason == motion::Reason::NO_SUCH_JOINT) {
            return fail(fmt::format("there is no joint {}", change.index));
        }
        if (reason != motion::Reason::NONE || !std::isfinite(change.value)) {
            return fail(fmt::format("{} of joint {} cannot be {}", info.ini_key, change.index, change.value),
                        {}, "the setting is unchanged");
        }
        const double low = after.get(Parameter::JOINT_MIN_LIMIT, change.index);
        const double high = after.get(Parameter::JOINT_MAX_LIMIT, change.index);
        if (low >= high) {
            return fail(fmt::format("the lower limit of joint {} cannot be {}, its upper limit is {}",
                                    change.index, low, high),
                        {}, "the limits are unchanged");
        }
    }
    return {};
}

}  // namespace mw::task

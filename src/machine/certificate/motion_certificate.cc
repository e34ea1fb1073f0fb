// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/certificate/motion_certificate.hh"

#include <algorithm>
#include <limits>

#include "motion/interface/settings.hh"

namespace mw::machine {
namespace {

using motion::Parameter;

constexpr double NONE = std::numeric_limits<double>::infinity();

/// The parameters of velocity, acceleration and jerk of one type of coordinate.
using LimitKeys = std::array<Parameter, DERIVATIVES>;
constexpr LimitKeys AXIS_KEYS{Parameter::AXIS_MAX_VELOCITY, Parameter::AXIS_MAX_ACCELERATION,
                              Parameter::AXIS_MAX_JERK};
constexpr LimitKeys JOINT_KEYS{Parameter::JOINT_MAX_VELOCITY, Parameter::JOINT_MAX_ACCELERATION,
                               Parameter::JOINT_MAX_JERK};
constexpr LimitKeys NORM_KEYS{Parameter::TRAJ_MAX_VELOCITY, Parameter::TRAJ_MAX_ACCELERATION,
                              Parameter::TRAJ_MAX_JERK};

std::array<double, DERIVATIVES> limits_of(const motion::Settings &settings, const LimitKeys &keys,
                                          int index) {
    std::array<double, DERIVATIVES> limits{};
    for (std::size_t i = 0; i < DERIVATIVES; ++i) {
        limits[i] = settings.get(keys[i], index);
    }
    const bool isJerkLimited =
        motion::isJerkLimited(settings) && limits[DERIVATIVES - 1] < motion::NO_JERK_LIMIT;
    limits[DERIVATIVES - 1] = isJerkLimited ? limits[DERIVATIVES - 1] : NONE;
    return limits;
}

const motion::MoveTerms *terms_of(const motion::PathBody &body) {
    return std::visit(
        [](const auto &move) -> const motion::MoveTerms * {
            if constexpr (requires { move.terms; }) {
                return &move.terms;
            } else {
                return nullptr;
            }
        },
        body);
}

}  // namespace

std::string last_certificate_file(const MachineConfig &machine) {
    const std::string &parameters = machine.task.parameter_file;
    return parameters.empty() ? parameters : parameters + ".certificate.json";
}

CertificateSettings certificate_settings(const MachineConfig &machine) {
    const motion::Settings settings = motion::settings_of(machine.parameters);
    CertificateSettings out;
    out.period_s = static_cast<double>(machine.servo_period_ns) * 1e-9;
    using Type = LimitedCoordinate::Type;
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        if ((machine.axis_mask & 1U << axis) != 0) {
            out.coordinates.push_back(
                {Type::AXIS, axis, geometry::isAngular(axis), limits_of(settings, AXIS_KEYS, axis)});
        }
    }
    for (int joint = 0; joint < machine.axis_map.num_led(); ++joint) {
        out.coordinates.push_back({Type::JOINT, joint, settings.isSet(Parameter::JOINT_IS_ANGULAR, joint),
                                   limits_of(settings, JOINT_KEYS, joint)});
    }
    out.coordinates.push_back({Type::XYZ_NORM, 0, false, limits_of(settings, NORM_KEYS, 0)});
    return out;
}

bool Certificate::isWithinLimits() const {
    return std::ranges::all_of(uses, [](const CoordinateUse &use) {
        return use.ratio(0) <= EXCEEDED && use.ratio(1) <= EXCEEDED && use.ratio(2) <= EXCEEDED;
    });
}

bool Certificate::isWithinTolerance() const {
    return deviations.tightest.ratio() <= EXCEEDED && deviations.exact.ratio() <= EXCEEDED;
}

MotionCertificate::MotionCertificate(const CertificateSettings &settings)
    : settings_(settings), limits_(settings.coordinates, settings.period_s) {}

void MotionCertificate::on_move(const task::SentMove &sent) {
    const motion::MoveTerms *terms = terms_of(sent.body);
    const auto piece = programmed_piece(sent.start, sent.body);
    if (terms == nullptr || !piece.has_value()) {
        return;
    }
    ProgrammedMove move;
    move.id = sent.id;
    move.piece = *piece;
    move.mode = terms->mode;
    move.tolerance = terms->tolerance;
    move.source = {terms->source.line, terms->source.file_index};
    move.isMeasured = !std::holds_alternative<motion::RigidTap>(sent.body);
    path_.on_move(move);
}

bool MotionCertificate::isContinuous(const motion::TraceSample &sample) {
    if (isFirst_) {
        start_ns_ = sample.time_ns;
        last_cycle_ = sample.cycle - 1;
        pose_kind_ = sample.pose_kind;
        isFirst_ = false;
    }
    const std::uint64_t missing = sample.cycle - last_cycle_ - 1;
    lost_ += missing;
    // Another kinematics type has another pose for the same joints. A machine that is off follows its
    // feedback.
    const bool isOtherPose = sample.pose_kind != pose_kind_ || sample.isEnabled == 0;
    pose_kind_ = sample.pose_kind;
    last_cycle_ = sample.cycle;
    return missing == 0 && !isOtherPose;
}

void MotionCertificate::take_held() {
    if (!held_.has_value()) {
        return;
    }
    held_->sample.source = path_.source();
    if (held_->isRestart) {
        limits_.restart();
    }
    limits_.remember(held_->sample);
    if (held_->isMeasured) {
        limits_.measure(held_->sample);
    }
    held_.reset();
}

void MotionCertificate::on_sample(const motion::TraceSample &sample) {
    constexpr int SETTLING = DERIVATIVES;
    const bool isRestart = !isContinuous(sample);
    // With jerk limits the commanded position reaches the end after the last move has ended.
    isProgram_ = sample.path_id != 0 || (isProgram_ && sample.isInMotion != 0);
    settling_ = isProgram_ ? SETTLING : std::max(0, settling_ - 1);
    const bool isFirstAfter = !isProgram_ && settling_ == SETTLING - 1;
    const std::int64_t time_ns = sample.time_ns - start_ns_;
    if ((isProgram_ || isFirstAfter) && sample.isRetracing == 0) {
        path_.on_sample(sample.programmed_pos_cmd, sample.path_id, time_ns);
    }
    take_held();
    held_ = HeldUse{{sample.carte_pos_cmd, sample.joint_pos_cmd, time_ns, {}}, settling_ > 0, isRestart};
    samples_ += isProgram_ ? 1 : 0;
}

void MotionCertificate::finish(ProgramEnd end) {
    if (end == ProgramEnd::COMPLETE) {
        path_.complete();
    } else {
        path_.flush();
    }
    take_held();
}

Certificate MotionCertificate::result() const {
    return {limits_.uses(), path_.deviations(), samples_, lost_};
}

}  // namespace mw::machine

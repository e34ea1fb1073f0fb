// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/readings.hh"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace mw::publish {
namespace {

using messages::MachineStatus;

std::string length_unit(double units_per_mm) {
    constexpr double MM_PER_INCH = 25.4, TOLERANCE = 1e-6;
    if (std::abs(units_per_mm - 1.0) < TOLERANCE) {
        return "mm";
    }
    return std::abs(units_per_mm * MM_PER_INCH - 1.0) < TOLERANCE ? "in" : "machine units";
}

bool isAngle(const Row &row, int index, const MachineStatus &status) {
    if (row.each == Each::JOINT) {
        return status.settings.joints[static_cast<std::size_t>(index)].kind == messages::JointKind::ANGULAR;
    }
    return row.each == Each::AXIS && geometry::isAngular(index);
}

bool isNear(const Value &now, const Value &before, double deadband) {
    const auto *const a = std::get_if<double>(&now), *const b = std::get_if<double>(&before);
    if (a == nullptr || b == nullptr) {
        return now == before;
    }
    if (!std::isfinite(*a) || !std::isfinite(*b)) {
        return *a == *b || (std::isnan(*a) && std::isnan(*b));
    }
    return deadband > 0 ? std::abs(*a - *b) < deadband : *a == *b;
}

std::string with_place(std::string_view name, const std::string &place) {
    const std::size_t at = name.find('#');
    return at == std::string_view::npos
               ? std::string(name)
               : std::string(name.substr(0, at)) + place + std::string(name.substr(at + 1));
}

}  // namespace

std::string unit_of(const Row &row, int index, const MachineStatus &status) {
    const auto path = FieldPath::find(FieldPath::first_of(row.fields));
    const std::string_view unit = path->unit();
    namespace name = messages::unit;
    const std::string length =
        isAngle(row, index, status) ? "deg" : length_unit(status.settings.linear_units);
    if (unit == name::LENGTH || unit == name::JOINT || unit == name::POSE) {
        return length;
    }
    if (unit == name::SPEED || unit == name::JOINT_SPEED) {
        return length + "/s";
    }
    if (unit == name::ACCELERATION || unit == name::JOINT_ACCELERATION) {
        return length + "/s2";
    }
    return unit == name::DEGREE ? "deg" : std::string(unit);
}

void Readings::add(const Row &row, int index, const std::string &place, const MachineStatus &status) {
    const auto changed = deadbands_.find(row.metric);
    metrics_.push_back({.name = with_place(row.metric, place),
                        .type = type_of(row),
                        .unit = unit_of(row, index, status),
                        .deadband = changed == deadbands_.end() ? row.deadband : changed->second,
                        .row = &row,
                        .index = index});
    paths_.push_back(*FieldPath::find(FieldPath::first_of(row.fields)));
}

Readings::Shape Readings::shape_of(const MachineStatus &status) {
    Shape shape{status.trajectory.axis_mask, 0, status.trajectory.num_joints, status.trajectory.num_spindles,
                status.settings.linear_units};
    for (std::size_t i = 0; i < MAX_JOINTS; ++i) {
        const bool isAngular = status.settings.joints[i].kind == messages::JointKind::ANGULAR;
        shape.angular_joints |= isAngular ? 1U << i : 0U;
    }
    return shape;
}

bool Readings::isOther(const MachineStatus &status) const {
    return shape_ != shape_of(status);
}

void Readings::fit(const MachineStatus &status) {
    shape_ = shape_of(status);
    metrics_.clear();
    paths_.clear();
    for (const Row &row : rows()) {
        const int count = row.each == Each::ONCE    ? 1
                          : row.each == Each::AXIS  ? static_cast<int>(geometry::AXIS_COUNT)
                          : row.each == Each::JOINT ? std::min(status.trajectory.num_joints, MAX_JOINTS)
                                                    : std::min(status.trajectory.num_spindles, MAX_SPINDLES);
        for (int i = 0; i < count; ++i) {
            const bool isAbsent = row.each == Each::AXIS && (status.trajectory.axis_mask >> i & 1U) == 0;
            if (!isAbsent) {
                add(row, i,
                    row.each == Each::AXIS ? std::string(1, geometry::AXIS_LETTERS[i]) : std::to_string(i),
                    status);
            }
        }
    }
    for (const char *name : {MESSAGE_METRIC, MESSAGE_TYPE_METRIC, MESSAGE_ID_METRIC}) {
        metrics_.push_back({.name = name, .type = DataType::STRING});
    }
    reported_.assign(metrics_.size(), Value());
}

Value Readings::read(std::size_t metric, const MachineStatus &status) const {
    const Metric &one = metrics_[metric];
    if (one.row == nullptr) {
        return reported_[metric];
    }
    return one.row->calculate != nullptr ? one.row->calculate(status, one.index)
                                         : paths_[metric].read(status, one.index);
}

std::vector<Value> Readings::all(const MachineStatus &status) {
    for (std::size_t i = 0; i < metrics_.size(); ++i) {
        reported_[i] = read(i, status);
    }
    return reported_;
}

std::vector<Change> Readings::changes(const MachineStatus &status) {
    std::vector<Change> changes;
    for (std::size_t i = 0; i < paths_.size(); ++i) {
        Value now = read(i, status);
        if (!isNear(now, reported_[i], metrics_[i].deadband)) {
            reported_[i] = now;
            changes.push_back({i, std::move(now)});
        }
    }
    return changes;
}

std::vector<Change> Readings::message(const std::string &kind, const std::string &text,
                                      const std::string &id) const {
    const std::size_t first = paths_.size();
    return {{first, clean_text(text)}, {first + 1, kind}, {first + 2, id}};
}

}  // namespace mw::publish

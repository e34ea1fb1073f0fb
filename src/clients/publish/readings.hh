// SPDX-License-Identifier: GPL-2.0-or-later
// The published values of one machine (axes, joints, spindles), each with name, type and unit.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "clients/publish/field_path.hh"
#include "clients/publish/table.hh"

namespace mw::publish {

/// Description of a published value.
struct Metric {
    std::string name{};
    DataType type = DataType::DOUBLE;
    std::string unit{};
    double deadband = 0;
    /// Null for messages to the operator.
    const Row *row = nullptr;
    int index = 0;  ///< number of the axis, joint or spindle

    bool operator==(const Metric &other) const = default;
};

struct Change {
    std::size_t metric = 0;  ///< index of the metric
    Value value;
};

/// Deadbands by the names of rows, which replace those of the table.
using Deadbands = std::map<std::string, double, std::less<>>;

/// All calls come from one thread. Reports a value when it differs from the last reported value by at least
/// its deadband.
class Readings {
  public:
    explicit Readings(Deadbands deadbands = {}) : deadbands_(std::move(deadbands)) {}

    /// Adapts the metrics to the axes, joints, spindles and units of the machine.
    void fit(const messages::MachineStatus &status);
    /// True if the metrics do not fit this machine.
    bool isOther(const messages::MachineStatus &status) const;
    const std::vector<Metric> &metrics() const { return metrics_; }
    /// Values of all metrics, which then count as reported.
    std::vector<Value> all(const messages::MachineStatus &status);
    std::vector<Change> changes(const messages::MachineStatus &status);
    /// The metrics of a message; `id` is unique.
    std::vector<Change> message(const std::string &kind, const std::string &text,
                                const std::string &id) const;

  private:
    Value read(std::size_t metric, const messages::MachineStatus &status) const;
    void add(const Row &row, int index, const std::string &place, const messages::MachineStatus &status);

    /// Properties of the machine that determine the metrics.
    struct Shape {
        std::uint32_t axes = 0, angular_joints = 0;
        int joints = 0, spindles = 0;
        double units_per_mm = 0;

        bool operator==(const Shape &other) const = default;
    };
    static Shape shape_of(const messages::MachineStatus &status);

    Deadbands deadbands_;
    Shape shape_;
    std::vector<Metric> metrics_;
    std::vector<FieldPath> paths_;  ///< paths of the metrics, without those of messages
    std::vector<Value> reported_;
};

/// The unit of a field for one machine: "mm" for machine units, "deg" for the degrees of a rotary axis.
std::string unit_of(const Row &row, int index, const messages::MachineStatus &status);

}  // namespace mw::publish

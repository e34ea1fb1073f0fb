// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/run/certificate_report.hh"

#include <array>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include "base/atomic_file.hh"

namespace mw::programs {
namespace {

using Json = nlohmann::ordered_json;
using machine::CoordinateUse;
using machine::Deviation;
using machine::LimitedCoordinate;
using Type = LimitedCoordinate::Type;

constexpr int VERSION = 1;  ///< version of the document; increased when a field changes its meaning

struct DerivativeText {
    const char *name;
    const char *unit;   ///< suffix of the coordinate's unit
    const char *field;  ///< as above, for names of fields
};
constexpr std::array<DerivativeText, machine::DERIVATIVES> DERIVATIVE_TEXTS{
    {{"velocity", "/s", "per_s"}, {"acceleration", "/s2", "per_s2"}, {"jerk", "/s3", "per_s3"}}};

double seconds(std::int64_t time_ns) {
    return static_cast<double>(time_ns) * 1e-9;
}

const char *length_unit(const CertificateReport &report) {
    return report.machine.metric ? "mm" : "in";
}

const char *unit_of(const CertificateReport &report, const LimitedCoordinate &coordinate) {
    return coordinate.isAngular ? "deg" : length_unit(report);
}

std::string name_of(const LimitedCoordinate &coordinate) {
    switch (coordinate.type) {
    case Type::AXIS: return std::string(1, geometry::AXIS_LETTERS[coordinate.index]);
    case Type::JOINT: return fmt::format("{}", coordinate.index);
    case Type::XYZ_NORM: break;
    }
    return "XYZ";
}

const char *type_of(const LimitedCoordinate &coordinate) {
    return coordinate.type == Type::AXIS ? "axis" : coordinate.type == Type::JOINT ? "joint" : "norm";
}

/// "axis X", "joint 0", "norm XYZ".
std::string title_of(const LimitedCoordinate &coordinate) {
    return fmt::format("{} {}", type_of(coordinate), name_of(coordinate));
}

void add_place(Json &json, const CertificateReport &report, const machine::ProgramLine &source,
               std::int64_t time_ns) {
    json["line"] = source.line;
    json["file"] = source.line > 0 ? report.file_name(source.file_index) : "";
    json["time_s"] = seconds(time_ns);
}

Json use_json(const CertificateReport &report, const CoordinateUse &use) {
    Json json{{"type", type_of(use.coordinate)},
              {"name", name_of(use.coordinate)},
              {"unit", unit_of(report, use.coordinate)}};
    for (std::size_t i = 0; i < machine::DERIVATIVES; ++i) {
        const machine::LargestUse &largest = use.largest[i];
        const std::string field = DERIVATIVE_TEXTS[i].field;
        Json one{{"largest_" + field, largest.value}, {"limit_" + field, nullptr}, {"ratio", nullptr}};
        if (use.hasLimit(i)) {
            one["limit_" + field] = use.coordinate.limit[i];
            one["ratio"] = use.ratio(i);
        }
        add_place(one, report, largest.source, largest.time_ns);
        json[DERIVATIVE_TEXTS[i].name] = std::move(one);
    }
    return json;
}

/// Null if there was none.
Json deviation_json(const CertificateReport &report, const Deviation &deviation) {
    if (deviation.distance() == 0) {
        return nullptr;
    }
    Json json{{"linear", deviation.linear},
              {"angular_deg", deviation.angular},
              {"tolerance", nullptr},
              {"ratio", nullptr}};
    if (deviation.tolerance > 0) {
        json["tolerance"] = deviation.tolerance;
        json["ratio"] = deviation.ratio();
    }
    add_place(json, report, deviation.source, deviation.time_ns);
    Json position = Json::object();
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        if ((report.machine.axis_mask & 1U << axis) != 0) {
            position[std::string(1, geometry::AXIS_LETTERS[axis])] = deviation.position[axis];
        }
    }
    json["position"] = std::move(position);
    return json;
}

std::string place_text(const CertificateReport &report, const machine::ProgramLine &source) {
    if (source.line == 0) {
        return "";
    }
    const std::string file = report.file_name(source.file_index);
    return file.empty() || file == report.program ? fmt::format("line {}", source.line)
                                                  : fmt::format("{}:{}", file, source.line);
}

std::string ratio_text(const CertificateReport &report, const CoordinateUse &use, std::size_t derivative) {
    if (!use.hasLimit(derivative)) {
        return fmt::format("{:>22}", "no limit");
    }
    const std::string place = place_text(report, use.largest[derivative].source);
    return fmt::format("{:>9.3f} % {:<11}", 100 * use.ratio(derivative), place);
}

std::string exceeded_text(const CertificateReport &report, const CoordinateUse &use) {
    std::string text;
    for (std::size_t i = 0; i < machine::DERIVATIVES; ++i) {
        if (use.ratio(i) > machine::EXCEEDED) {
            const std::string unit = unit_of(report, use.coordinate) + std::string(DERIVATIVE_TEXTS[i].unit);
            text += fmt::format("LIMIT EXCEEDED      {}: {} {:.6g} {}, limit {:.6g} {}, {}, at {:.3f} s\n",
                                title_of(use.coordinate), DERIVATIVE_TEXTS[i].name, use.largest[i].value,
                                unit, use.coordinate.limit[i], unit,
                                place_text(report, use.largest[i].source), seconds(use.largest[i].time_ns));
        }
    }
    return text;
}

std::string deviation_text(const CertificateReport &report, const char *label, const Deviation &deviation) {
    const char *unit = length_unit(report);
    std::string text = fmt::format("{:<20}{:.6f} {}", label, deviation.linear, unit);
    if (deviation.angular > 0) {
        text += fmt::format(", {:.6f} deg", deviation.angular);
    }
    if (deviation.distance() > 0) {
        text += fmt::format(" at {}", place_text(report, deviation.source));
        for (int axis = 0; axis < MAX_AXES; ++axis) {
            if ((report.machine.axis_mask & 1U << axis) != 0) {
                text += fmt::format(" {}{:.3f}", geometry::AXIS_LETTERS[axis], deviation.position[axis]);
            }
        }
        text += deviation.tolerance > 0 ? fmt::format(", {:.1f} % of the tolerance {:g}",
                                                      100 * deviation.ratio(), deviation.tolerance)
                                        : ", no tolerance there";
    }
    return text + '\n';
}

}  // namespace

std::string certificate_json(const CertificateReport &report) {
    const machine::Certificate &found = report.certificate;
    Json json{{"format", "millwright motion certificate"},
              {"version", VERSION},
              {"program", report.program},
              {"machine", report.machine.name},
              {"clock", report.was_realtime ? "realtime" : "virtual"},
              {"finished", report.wasFinished},
              {"length_unit", length_unit(report)},
              {"cycle_time_s", report.cycle_time_s},
              {"servo_period_s", seconds(report.machine.servo_period_ns)},
              {"samples", found.samples},
              {"lost_samples", found.lost_samples},
              {"within_limits", found.isWithinLimits()},
              {"within_tolerance", found.isWithinTolerance()},
              {"limits", Json::array()}};
    for (const CoordinateUse &use : found.uses) {
        json["limits"].push_back(use_json(report, use));
    }
    json["deviation"] = {{"largest", deviation_json(report, found.deviations.largest)},
                         {"largest_ratio", deviation_json(report, found.deviations.tightest)},
                         {"exact_path", deviation_json(report, found.deviations.exact)}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

Result<> write_certificate(const CertificateReport &report, const std::string &path) {
    return write_file_atomically(path, certificate_json(report));
}

std::string certificate_table(const CertificateReport &report) {
    const machine::Certificate &found = report.certificate;
    std::string text =
        fmt::format("{:<20}{:<22}  {:<22}  {}\n", "largest use of", "velocity", "acceleration", "jerk");
    std::string exceeded;
    for (const CoordinateUse &use : found.uses) {
        if (use.coordinate.type == Type::XYZ_NORM && !use.hasLimit(0) && !use.hasLimit(1) &&
            !use.hasLimit(2)) {
            continue;
        }
        text += fmt::format("  {:<16}{}  {}  {}\n", title_of(use.coordinate), ratio_text(report, use, 0),
                            ratio_text(report, use, 1), ratio_text(report, use, 2));
        exceeded += exceeded_text(report, use);
    }
    text += deviation_text(report, "path deviation", found.deviations.largest);
    const Deviation &tightest = found.deviations.tightest;
    if (tightest.ratio() > 0 && tightest.time_ns != found.deviations.largest.time_ns) {
        text += deviation_text(report, "nearest tolerance", tightest);
    }
    for (const Deviation *one : {&tightest, &found.deviations.exact}) {
        if (one->ratio() > machine::EXCEEDED) {
            exceeded += deviation_text(report, "TOLERANCE EXCEEDED", *one);
        }
    }
    if (found.lost_samples > 0) {
        exceeded +=
            fmt::format("certificate         incomplete: {} servo cycles are missing\n", found.lost_samples);
    }
    return text + exceeded;
}

std::string certificate_line(const CertificateReport &report) {
    const CoordinateUse *most = nullptr;
    std::size_t derivative = 0;
    for (const CoordinateUse &use : report.certificate.uses) {
        for (std::size_t i = 0; i < machine::DERIVATIVES; ++i) {
            if (use.hasLimit(i) && (most == nullptr || use.ratio(i) > most->ratio(derivative))) {
                most = &use;
                derivative = i;
            }
        }
    }
    std::string text = fmt::format("{}: motion certified", report.program);
    if (most != nullptr) {
        text += fmt::format(", at most {:.3f} % of {} of {} ({})", 100 * most->ratio(derivative),
                            DERIVATIVE_TEXTS[derivative].name, title_of(most->coordinate),
                            place_text(report, most->largest[derivative].source));
    }
    const Deviation &largest = report.certificate.deviations.largest;
    return text + fmt::format(", path deviation {:.6f} {} ({})", largest.linear, length_unit(report),
                              place_text(report, largest.source));
}

}  // namespace mw::programs

// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/interface/screw_file.hh"

#include <array>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/core.h>

#include "base/atomic_file.hh"
#include "base/text.hh"

namespace mw::motion {

namespace {

constexpr std::string_view BLANKS = " \t\r\v\f";
constexpr std::uintmax_t MOST_BYTES = 4'000'000;

struct ScrewLine {
    std::array<double, 3> value{};
    std::array<int, 3> column{};
};

/// Parses a line of three numbers; nothing for an empty line or a comment.
Result<std::optional<ScrewLine>> parse_line(std::string_view line, SourcePlace place) {
    line = line.substr(0, line.find('#'));
    ScrewLine out;
    std::size_t count = 0;
    for (std::size_t begin = line.find_first_not_of(BLANKS); begin != std::string_view::npos; ++count) {
        const std::size_t end = std::min(line.find_first_of(BLANKS, begin), line.size());
        const std::string_view word = line.substr(begin, end - begin);
        place.column = static_cast<int>(begin) + 1;
        if (count == out.value.size()) {
            return fail("more than three numbers in a line", place);
        }
        const auto value = parse_double(word);
        if (!value.has_value()) {
            return fail(
                fmt::format("'{}' is not a number", printable(word.substr(0, 40))), place,
                "a line has three numbers: position, value for forward travel, value for reverse travel");
        }
        out.value[count] = *value;
        out.column[count] = place.column;
        begin = line.find_first_not_of(BLANKS, end);
    }
    if (count == 0) {
        return std::nullopt;
    }
    if (count < out.value.size()) {
        place.column = static_cast<int>(line.find_last_not_of(BLANKS)) + 2;
        return fail(fmt::format("{} of three numbers in a line", count), place);
    }
    return out;
}

/// Reason why a point cannot follow the previous point.
Result<> check_step(const LoadCompensation &last, const LoadCompensation &next, const ScrewLine &line,
                    SourcePlace place) {
    place.column = line.column[0];
    const double way = next.nominal - last.nominal;
    if (!(way > 0)) {
        return fail(fmt::format("the position {} is not above {} of the point before it",
                                to_text(next.nominal), to_text(last.nominal)),
                    place, "list the points in increasing order");
    }
    const double rises[] = {next.forward - last.forward, next.reverse - last.reverse};
    for (std::size_t i = 0; i < 2; ++i) {
        place.column = line.column[i + 1];
        if (!(std::abs(rises[i]) <= STEEPEST_SCREW * way)) {
            return fail(fmt::format("the correction changes by {:.6g} over {:.6g} units: more than the {} of "
                                    "the joint's speed that corrections have",
                                    rises[i], way, to_text(STEEPEST_SCREW)),
                        place, "type 0 has positions, type 1 has corrections: see COMP_FILE_TYPE");
        }
    }
    return {};
}

LoadCompensation point_of(const ScrewLine &line, int joint, ScrewFileType type) {
    LoadCompensation point;
    point.joint = joint;
    point.nominal = line.value[0];
    const bool isActual = type == ScrewFileType::ACTUAL;
    point.forward = isActual ? line.value[0] - line.value[1] : line.value[1];
    point.reverse = isActual ? line.value[0] - line.value[2] : line.value[2];
    return point;
}

}  // namespace

Result<std::vector<LoadCompensation>> parse_screw_file(std::string_view text, const std::string &path,
                                                       int joint, ScrewFileType type) {
    std::vector<LoadCompensation> points;
    SourcePlace place{path, 0, 0};
    while (!text.empty()) {
        ++place.line;
        const std::size_t end = std::min(text.find('\n'), text.size());
        const auto line = parse_line(text.substr(0, end), place);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (!line.has_value()) {
            return std::unexpected(line.error());
        }
        if (!line->has_value()) {
            continue;
        }
        if (points.size() == MAX_SCREW_POINTS) {
            return fail(fmt::format("more than {} points", MAX_SCREW_POINTS), place);
        }
        LoadCompensation point = point_of(**line, joint, type);
        point.index = static_cast<int>(points.size());
        if (!points.empty()) {
            const auto step = check_step(points.back(), point, **line, place);
            if (!step.has_value()) {
                return std::unexpected(step.error());
            }
        }
        points.push_back(point);
    }
    if (points.empty()) {
        return fail("there is no point in this table of screw errors", {path, 0, 0});
    }
    for (LoadCompensation &point : points) {
        point.count = static_cast<int>(points.size());
    }
    return points;
}

Result<std::vector<LoadCompensation>> read_screw_file(const std::string &path, int joint,
                                                      ScrewFileType type) {
    std::error_code error;
    const bool isFile = std::filesystem::is_regular_file(path, error);
    if (std::filesystem::exists(path, error) && !isFile) {
        return fail("the table of screw errors must be a file", {path, 0, 0});
    }
    if (isFile && std::filesystem::file_size(path, error) > MOST_BYTES) {
        return fail(fmt::format("a table of screw errors has at most {} bytes", MOST_BYTES), {path, 0, 0});
    }
    const auto text = read_file(path);
    if (!text.has_value()) {
        return std::unexpected(text.error());
    }
    return parse_screw_file(*text, path, joint, type);
}

}  // namespace mw::motion

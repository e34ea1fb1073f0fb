// SPDX-License-Identifier: GPL-2.0-or-later
// Writes each kind of program as G-code (NAME.ngc) and as plain geometry with its limits (NAME.json, which
// tools/trajcheck.py reads), for other planners and other checkers. traj_programs FOLDER
#include <algorithm>
#include <cstdio>
#include <string>

#include "traj/kinds.hh"

namespace mw::bench {
namespace {

constexpr double SECONDS_PER_MINUTE = 60;

std::string file_stem(const Program &program) {
    std::string stem = program.name;
    std::replace(stem.begin(), stem.end(), ' ', '_');
    return stem;
}

/// Writes the words of coordinates that differ.
void write_words(std::FILE *file, const Pose &from, const Pose &to) {
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        if (from[i] != to[i]) {
            std::fprintf(file, " %c%.7f", geometry::AXIS_LETTERS[i], to[i]);
        }
    }
}

void write_move(std::FILE *file, const Pose &from, const Move &m) {
    if (!m.isArc) {
        std::fputs(m.feed == 0 ? "G0" : "G1", file);
        write_words(file, from, m.end);
        std::fputc('\n', file);
        return;
    }
    const double turns = std::abs(m.angle_rad) / (2 * std::acos(-1.0));
    std::fputs(m.angle_rad * m.normal[2] > 0 ? "G3" : "G2", file);
    std::fprintf(file, " X%.7f Y%.7f", m.end[0], m.end[1]);
    if (m.end[2] != from[2]) {
        std::fprintf(file, " Z%.7f", m.end[2]);
    }
    std::fprintf(file, " I%.7f J%.7f", m.centre[0] - from[0], m.centre[1] - from[1]);
    if (turns > 1 + 1e-9) {
        std::fprintf(file, " P%d", static_cast<int>(std::ceil(turns - 1e-9)));
    }
    std::fputc('\n', file);
}

/// Writes a rapid to the start, a dwell, then the moves.
bool write_gcode(const Program &program, const std::string &path) {
    std::FILE *file = std::fopen(path.c_str(), "w");
    if (file == nullptr) {
        std::perror(path.c_str());
        return false;
    }
    std::fprintf(file, "(%s)\nG21 G17 G90 G94 G54 G40 G49 G80\nG61.1\nG0", program.name.c_str());
    Pose elsewhere = program.start;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        elsewhere[i] += i == 0 || program.start[i] != 0 ? 1 : 0;
    }
    write_words(file, elsewhere, program.start);
    std::fputs("\nG4 P0.5\n", file);
    const geometry::PathMode control = program.moves[0].control;
    if (control == geometry::PathMode::BLEND) {
        std::fprintf(file, "G64 P%.7f\n", program.tolerance);
    } else {
        std::fputs(control == geometry::PathMode::EXACT_PATH ? "G61\n" : "G61.1\n", file);
    }
    Pose from = program.start;
    double feed = 0;
    for (const Move &m : program.moves) {
        if (m.feed != 0 && m.feed != feed) {
            feed = m.feed;
            std::fprintf(file, "F%.7f\n", feed * SECONDS_PER_MINUTE);
        }
        write_move(file, from, m);
        from = m.end;
    }
    std::fputs("M2\n", file);
    return std::fclose(file) == 0;
}

void write_pose(std::FILE *file, const char *name, const Pose &p) {
    std::fprintf(file, "\"%s\": [", name);
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        std::fprintf(file, "%s%.17g", i == 0 ? "" : ", ", p[i]);
    }
    std::fputc(']', file);
}

bool write_geometry(const Program &program, const std::string &path) {
    std::FILE *file = std::fopen(path.c_str(), "w");
    if (file == nullptr) {
        std::perror(path.c_str());
        return false;
    }
    const bool isExact = program.moves[0].control != geometry::PathMode::BLEND;
    std::fprintf(file, "{\"name\": \"%s\", \"tolerance\": %.17g,\n ", program.name.c_str(),
                 isExact ? 0.0 : program.tolerance);
    write_pose(file, "max_velocity", program.max_velocity);
    std::fputs(",\n ", file);
    write_pose(file, "max_acceleration", program.max_acceleration);
    std::fputs(",\n ", file);
    write_pose(file, "max_jerk", program.max_jerk);
    std::fputs(",\n ", file);
    write_pose(file, "start", program.start);
    std::fputs(",\n \"moves\": [", file);
    const char *separator = "\n  {";
    for (const Move &m : program.moves) {
        std::fputs(separator, file);
        separator = ",\n  {";
        write_pose(file, "end", m.end);
        if (m.isArc) {
            std::fputs(", ", file);
            write_pose(file, "centre", m.centre);
            std::fputs(", ", file);
            write_pose(file, "normal", m.normal);
            std::fprintf(file, ", \"angle_rad\": %.17g", m.angle_rad);
        }
        std::fprintf(file, ", \"feed\": %.17g}", m.feed);
    }
    std::fputs("]}\n", file);
    return std::fclose(file) == 0;
}

}  // namespace
}  // namespace mw::bench

int main(int argc, char **argv) {
    if (argc != 2) {
        std::fputs("usage: traj_programs FOLDER\n", stderr);
        return 2;
    }
    bool isOk = true;
    for (const mw::bench::Program &program : mw::bench::all_kinds()) {
        const std::string stem = std::string(argv[1]) + "/" + mw::bench::file_stem(program);
        isOk = mw::bench::write_gcode(program, stem + ".ngc") && isOk;
        isOk = mw::bench::write_geometry(program, stem + ".json") && isOk;
    }
    return isOk ? 0 : 1;
}

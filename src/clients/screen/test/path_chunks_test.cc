// SPDX-License-Identifier: GPL-2.0-or-later
// Decodes a path from its chunks by docs/reference/api.md, and compares it with the program (J3).
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "clients/screen/path/path_chunks.hh"

namespace mw::screen {
namespace {

struct Point {
    std::array<float, 3> place;
    std::uint32_t line;
    std::uint8_t kind;
};

/// Decodes the bytes as a browser does.
struct Range {
    std::uint32_t first;
    float feed;
    std::uint32_t tool;
    bool operator==(const Range &) const = default;
};

struct Offset {
    std::uint32_t first;
    std::array<float, 3> xyz;
    bool operator==(const Offset &) const = default;
};

struct Path {
    std::vector<std::vector<Point>> moves, wires;
    std::vector<Range> ranges;
    std::vector<Offset> offsets;
    std::vector<std::uint32_t> rotary_lines;
    std::array<float, 6> bounds{};
    std::uint32_t lines = 0, points = 0;
    std::string error;
    std::vector<std::uint32_t> kinds;

    explicit Path(const std::string &bytes) { take(bytes); }
    void take(const std::string &bytes) {
        std::size_t at = 0;
        const auto word = [&] {
            std::uint32_t value = 0;
            std::memcpy(&value, bytes.data() + at, 4);
            at += 4;
            return value;
        };
        while (at < bytes.size()) {
            const std::uint32_t kind = word(), size = word();
            EXPECT_EQ(size % 4, 0U);
            const std::size_t end = at + size;
            ASSERT_LE(end, bytes.size());
            kinds.push_back(kind);
            if (kind == 1) {
                const std::uint32_t count = word();
                take_moves(bytes, at, count, moves);
            } else if (kind == 5) {
                for (std::uint32_t left = word(); left > 0; --left) {
                    std::memcpy(&ranges.emplace_back(), bytes.data() + at, sizeof(Range));
                    at += sizeof(Range);
                }
            } else if (kind == 9) {
                for (std::uint32_t left = word(); left > 0; --left) {
                    std::memcpy(&offsets.emplace_back(), bytes.data() + at, sizeof(Offset));
                    at += sizeof(Offset);
                }
            } else if (kind == 10) {
                rotary_lines.push_back(word());
            } else if (kind == 6) {
                const std::uint32_t count = word();
                take_moves(bytes, at, count, wires);
            } else if (kind == 2) {
                std::memcpy(bounds.data(), bytes.data() + at, sizeof bounds);
            } else if (kind == 3) {
                lines = word();
                points = word();
            } else {
                error = bytes.substr(at, size);
            }
            at = end;
        }
    }
    static void take_moves(const std::string &bytes, std::size_t at, std::uint32_t count,
                           std::vector<std::vector<Point>> &to) {
        std::vector<Point> &points_of = to.emplace_back(count);
        for (std::size_t i = 0; i < count; ++i) {
            std::memcpy(points_of[i].place.data(), bytes.data() + at + 12 * i, 12);
            std::memcpy(&points_of[i].line, bytes.data() + at + 12 * count + 4 * i, 4);
            points_of[i].kind = static_cast<std::uint8_t>(bytes[at + 16 * count + i]);
        }
    }
};

gcode::PreviewEvent move(gcode::PreviewKind kind, const geometry::Pose &from, const geometry::Pose &to,
                         int line) {
    gcode::PreviewEvent event;
    event.kind = kind;
    event.start = from;
    event.end = to;
    event.line = line;
    return event;
}

TEST(PathChunks, PointsLinesAndKindsComeBack) {
    std::string bytes;
    PathChunks chunks(
        [&](std::string piece) {
            bytes += piece;
            return true;
        },
        1);
    const geometry::Pose a{{1, 2, 3}}, b{{4, -5, 6}}, c{{0, 0, -7}};
    const std::array events{move(gcode::PreviewKind::RAPID, a, b, 3), move(gcode::PreviewKind::FEED, b, c, 4),
                            move(gcode::PreviewKind::DWELL, c, c, 5),
                            move(gcode::PreviewKind::PROBE, c, a, 6)};
    EXPECT_TRUE(chunks.take(events));
    chunks.error("p.ngc:7: wrong");
    chunks.end(9);
    const Path path(bytes);
    ASSERT_EQ(path.moves.size(), 1U);
    const auto &points = path.moves[0];
    ASSERT_EQ(points.size(), 4U);
    EXPECT_EQ(points[0].place, (std::array<float, 3>{1, 2, 3}));
    EXPECT_EQ(points[1].place, (std::array<float, 3>{4, -5, 6}));
    EXPECT_EQ(points[1].line, 3U);
    EXPECT_EQ(points[1].kind, 0);
    EXPECT_EQ(points[2].kind, 1);
    EXPECT_EQ(points[3].line, 6U);
    EXPECT_EQ(points[3].kind, 3);
    EXPECT_EQ(path.bounds, (std::array<float, 6>{0, -5, -7, 4, 2, 6}));
    EXPECT_EQ(path.lines, 9U);
    EXPECT_EQ(path.points, 4U);
    EXPECT_EQ(path.error, "p.ngc:7: wrong  ");
}

TEST(PathChunks, AnArcIsChordsNearItsCircle) {
    for (const double radius : {0.01, 1.0, 80.0}) {
        std::string bytes;
        PathChunks chunks(
            [&](std::string piece) {
                bytes += piece;
                return true;
            },
            1);
        auto arc = move(gcode::PreviewKind::ARC, geometry::Pose{{10 + radius, 5, 0}},
                        geometry::Pose{{10, 5 + radius, -3}}, 1);
        arc.centre = geometry::Pose{{10, 5, 0}};
        arc.normal = geometry::Pose{{0, 0, 1}};
        arc.angle_rad = 2.5 * std::numbers::pi;
        EXPECT_TRUE(chunks.take(std::array{arc}));
        chunks.end(1);
        const auto points = Path(bytes).moves.at(0);
        double turned = 0;
        for (std::size_t i = 1; i < points.size(); ++i) {
            const double x = points[i].place[0] - 10, y = points[i].place[1] - 5;
            const double x0 = points[i - 1].place[0] - 10, y0 = points[i - 1].place[1] - 5;
            const double rounding = 4e-5;  // rounding of a float at 100
            EXPECT_NEAR(std::hypot(x, y), radius, rounding);
            EXPECT_GT(std::hypot((x + x0) / 2, (y + y0) / 2), radius - PathChunks::DEVIATION_MM - rounding);
            turned += std::atan2(x0 * y - y0 * x, x0 * x + y0 * y);
            EXPECT_NEAR(points[i].place[2], -3 * turned / arc.angle_rad, 2e-2);
        }
        EXPECT_NEAR(turned, arc.angle_rad, 0.02) << radius;
        EXPECT_EQ(points.back().place, (std::array<float, 3>{10, static_cast<float>(5 + radius), -3}));
    }
}

TEST(PathChunks, TheFirstPathComesAtOnceAndChunksGoOnWhereTheLastEnded) {
    std::vector<std::string> pieces;
    PathChunks chunks(
        [&](std::string piece) {
            pieces.push_back(std::move(piece));
            return true;
        },
        1);
    geometry::Pose at;
    int line = 0;
    const auto batch = [&](std::size_t count) {
        std::vector<gcode::PreviewEvent> events;
        for (std::size_t i = 0; i < count; ++i) {
            const geometry::Pose from = at;
            at[0] += 1;
            events.push_back(move(gcode::PreviewKind::FEED, from, at, ++line));
        }
        return events;
    };
    EXPECT_TRUE(chunks.take(batch(10)));
    EXPECT_EQ(pieces.size(), 2U) << "its values, and the path";
    for (int i = 0; i < 40; ++i) {
        EXPECT_TRUE(chunks.take(batch(1000)));
    }
    chunks.end(static_cast<std::uint32_t>(line));
    std::string bytes;
    for (const std::string &piece : pieces) {
        bytes += piece;
    }
    const Path path(bytes);
    ASSERT_GE(path.moves.size(), 3U);
    std::uint32_t count = 1;
    for (std::size_t i = 1; i < path.moves.size(); ++i) {
        EXPECT_EQ(path.moves[i].front().place, path.moves[i - 1].back().place);
    }
    for (const auto &moves : path.moves) {
        count += static_cast<std::uint32_t>(moves.size()) - 1;
        EXPECT_LE(moves.size(), PathChunks::POINTS_PER_CHUNK + 1);
    }
    EXPECT_EQ(count, 40011U);
    EXPECT_EQ(path.points, count);
    EXPECT_EQ(path.kinds.back(), 3U);
}

TEST(PathChunks, NothingIsMadeForNobody) {
    int pushed = 0;
    PathChunks chunks(
        [&](const std::string &) {
            ++pushed;
            return false;
        },
        1);
    const std::array events{move(gcode::PreviewKind::FEED, {}, geometry::Pose{{1}}, 1)};
    EXPECT_FALSE(chunks.take(events));
    EXPECT_FALSE(chunks.take(events));
    chunks.error("x");
    chunks.end(1);
    EXPECT_EQ(pushed, 1);
}

/// The chunks of these events.
Path path_of(std::span<const gcode::PreviewEvent> events, PathLook look = {}) {
    std::string bytes;
    PathChunks chunks(
        [&](std::string piece) {
            bytes += piece;
            return true;
        },
        1, std::move(look));
    EXPECT_TRUE(chunks.take(events));
    chunks.end(1);
    return Path(bytes);
}

TEST(PathChunks, FeedAndToolStandWhereTheyBegin) {
    const geometry::Pose a{{0, 0, 0}}, b{{1, 0, 0}}, c{{2, 0, 0}}, d{{3, 0, 0}}, e{{4, 0, 0}};
    std::vector<gcode::PreviewEvent> events{
        move(gcode::PreviewKind::FEED, a, b, 1), move(gcode::PreviewKind::RAPID, b, c, 2),
        move(gcode::PreviewKind::FEED, c, d, 3), move(gcode::PreviewKind::TOOL_CHANGE, d, d, 4),
        move(gcode::PreviewKind::FEED, d, e, 5)};
    events[0].settings.feed = events[2].settings.feed = 10;
    events[3].number = 7;
    events[4].settings.feed_per_revolution = 0.5;
    events[4].spindle_rpm = 1200;
    const Path path = path_of(events);
    EXPECT_EQ(path.ranges, (std::vector<Range>{{0, 10, 0}, {4, 10, 7}}));
}

TEST(PathChunks, ToolOffsetsHoldFromTheirPointOn) {
    const geometry::Pose a{{0, 0, 0}}, b{{1, 0, 0}}, c{{2, 0, 0}}, d{{3, 0, 0}};
    std::vector<gcode::PreviewEvent> events{
        move(gcode::PreviewKind::RAPID, a, b, 1), move(gcode::PreviewKind::FEED, b, c, 2),
        move(gcode::PreviewKind::FEED, c, d, 3), move(gcode::PreviewKind::RAPID, d, a, 4)};
    events[1].tool_offset = events[2].tool_offset = geometry::Pose{{0.5, 0, 40}};
    const Path path = path_of(events);
    EXPECT_EQ(path.offsets, (std::vector<Offset>{{2, {0.5F, 0, 40}}, {4, {0, 0, 0}}}));
    EXPECT_TRUE(path_of(std::span(events).first(1)).offsets.empty());
}

TEST(PathChunks, TheFirstMoveOfARotaryAxisIsReportedOnce) {
    geometry::Pose turned{{1, 0, 0}};
    turned[geometry::AXIS_B] = 5;
    const std::array events{move(gcode::PreviewKind::RAPID, {}, geometry::Pose{{1, 0, 0}}, 1),
                            move(gcode::PreviewKind::FEED, geometry::Pose{{1, 0, 0}}, turned, 2),
                            move(gcode::PreviewKind::FEED, turned, {}, 3)};
    EXPECT_EQ(path_of(events).rotary_lines, std::vector<std::uint32_t>{2});
    EXPECT_TRUE(path_of(std::span(events).first(1)).rotary_lines.empty());
}

TEST(PathChunks, EachChunkBringsItsRanges) {
    std::vector<gcode::PreviewEvent> events;
    constexpr std::uint32_t MANY = 3 * PathChunks::POINTS_PER_CHUNK;
    for (std::uint32_t i = 0; i < MANY; ++i) {
        events.push_back(
            move(gcode::PreviewKind::FEED, geometry::Pose{{double(i)}}, geometry::Pose{{i + 1.0}}, 1));
        events.back().settings.feed = 1.0 + (i / 1000);
    }
    const Path path = path_of(events);
    ASSERT_EQ(path.ranges.size(), (MANY + 999) / 1000);
    for (std::size_t i = 1; i < path.ranges.size(); ++i) {
        EXPECT_EQ(path.ranges[i],
                  (Range{static_cast<std::uint32_t>(1000 * i + 1), 1.0F + static_cast<float>(i), 0}));
    }
}

TEST(PathChunks, AFoamCutterHasTwoEnds) {
    geometry::Pose to{{1, 2, 9}};
    to[geometry::AXIS_U] = 3;
    to[geometry::AXIS_V] = 4;
    const std::array events{move(gcode::PreviewKind::FEED, geometry::Pose{}, to, 1)};
    PathLook look;
    look.foam = {5, 50};
    const Path path = path_of(events, look);
    ASSERT_EQ(path.wires.size(), 1U);
    EXPECT_EQ(path.moves[0][1].place, (std::array<float, 3>{1, 2, 5}));
    EXPECT_EQ(path.wires[0][1].place, (std::array<float, 3>{3, 4, 50}));
    EXPECT_EQ(path.bounds, (std::array<float, 6>{0, 0, 5, 3, 4, 50}));
}

TEST(PathGeometry, LettersAreDoneFromTheLastToTheFirst) {
    geometry::Pose pose{{10, 2, 3, 90}};
    const auto placed = [&](const char *text) { return PathGeometry::parse(text, "XYZA")->place(pose); };
    const auto expect = [](const Place &is, const Place &wanted) {
        for (std::size_t i = 0; i < is.size(); ++i) {
            EXPECT_NEAR(is[i], wanted[i], 1e-12) << i;
        }
    };
    expect(placed("XYZABCUVW"), {10, 2, 3});
    expect(placed("AXYZ"), {10, -3, 2});
    expect(placed("-AXYZ"), {10, 3, -2});
    expect(placed("XAYZ"), {10, -3, 2});
    expect(placed("ZAXY"), {10, 0, 5});
    expect(placed("-XYZ"), {-10, 2, 3});
    expect(placed("!AXYZ"), {10, -3, 2});
    EXPECT_TRUE(PathGeometry().isPlain());
    EXPECT_TRUE(PathGeometry::parse("XYZABCUVW", "XYZA")->isPlain());
    EXPECT_FALSE(PathGeometry::parse("AXYZ", "XYZA")->isPlain());
    EXPECT_TRUE(PathGeometry::parse("AXYZ", "XYZ")->isPlain()) << "there is no A to turn by";
    EXPECT_FALSE(PathGeometry::parse("-XYZ", "XYZ")->isPlain());
    EXPECT_FALSE(PathGeometry::parse("XYZUVW", "XYZU")->isPlain());
    EXPECT_FALSE(PathGeometry::parse("XY9", "XYZ").has_value());
}

TEST(PathChunks, AStraightMoveThatTurnsIsACurve) {
    PathLook look;
    look.geometry = *PathGeometry::parse("AXYZ", "XYZA");
    const std::array events{
        move(gcode::PreviewKind::FEED, geometry::Pose{{0, 10, 0, 0}}, geometry::Pose{{6, 10, 0, 360}}, 1)};
    const Path path = path_of(events, look);
    ASSERT_EQ(path.moves[0].size(), 121U);
    for (const Point &point : path.moves[0]) {
        EXPECT_NEAR(std::hypot(point.place[1], point.place[2]), 10, 1e-5);
    }
    EXPECT_NEAR(path.moves[0][60].place[0], 3, 1e-6);
    EXPECT_NEAR(path.moves[0][30].place[2], 10, 1e-5) << "a positive turn about X lifts Y to Z";
}

}  // namespace
}  // namespace mw::screen

// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/support/stock/lathe_job.hh"

#include <map>

#include <fmt/format.h>

namespace mw::testing {
namespace {

constexpr double MM_PER_INCH = 25.4;

class Maker {
  public:
    explicit Maker(unsigned seed) : random_(seed) { job_.seed = seed; }
    LatheJob make();

  private:
    double number(double low, double high) {
        return low + (high - low) * static_cast<double>(random_() - std::mt19937::min()) /
                         (static_cast<double>(std::mt19937::max()) + 1.0);
    }
    bool chance(double part) { return number(0, 1) < part; }
    int pick(int count) { return static_cast<int>(number(0, count)); }

    void choose_frame();
    void make_contour();
    bool add_line(double du, double dh);
    bool add_arc(double du, double dh);
    bool add_tangent_arc();
    void push(Stroke stroke);
    Place rounded(Place p) const;
    double to_program(double mm) const { return job_.isInch ? mm / MM_PER_INCH : mm; }
    std::string word(char letter, double program_units) const;
    std::string words_to(Place p, Place from, bool isAll) const;
    std::string arc_words(const Stroke &arc, std::size_t number);
    void choose_start();
    void choose_cycles();
    std::string cycle_words(const JobCycle &cycle, bool hasStart);

    std::mt19937 random_;
    LatheJob job_;
    int digits_ = 3;
    std::map<std::size_t, double> radii_;  ///< radii of arcs with R, by the number of strokes
};

/// Rounded to the digits of the program.
Place Maker::rounded(Place p) const {
    const double unit = std::pow(10.0, digits_), scale = job_.isInch ? MM_PER_INCH : 1.0;
    const auto round = [&](double mm, double origin, double sign, bool isX) {
        const double factor = unit / scale * (isX && job_.isDiameter ? 2.0 : 1.0);
        const double machine = std::round((mm * sign + origin) * factor) / factor;
        return (machine - origin) * sign;
    };
    return {round(p.u, job_.along_origin, job_.along_sign, job_.isFacing),
            round(p.h, job_.across_origin, job_.across_sign, !job_.isFacing)};
}

void Maker::choose_frame() {
    job_.isFacing = chance(0.4);
    job_.isInside = chance(0.4);
    job_.isInch = chance(0.25);
    job_.isDiameter = chance(0.4);
    digits_ = (chance(0.5) ? 3 : 4) + (job_.isInch ? 1 : 0);
    job_.along_sign = chance(0.75) ? -1.0 : 1.0;
    job_.across_sign = job_.isInside ? -1.0 : 1.0;
    if (job_.isFacing) {  // heights along Z, the cut along X, which stays above 0
        job_.along_origin = job_.along_sign < 0.0 ? 100.0 : 2.0;
        job_.across_origin = std::round(number(-50, 50));
    } else {
        job_.along_origin = std::round(number(-20, 20));
        job_.across_origin = job_.isInside ? 80.0 : 0.0;
    }
}

void Maker::push(Stroke stroke) {
    job_.contour.strokes.push_back(stroke);
    radii_.erase(job_.contour.strokes.size());
    job_.hasArcs = job_.hasArcs || stroke.isArc;
    job_.isMonotonic = job_.isMonotonic && stroke.to.h >= stroke.from.h - 1e-9 &&
                       stroke.at(0.5).h >= stroke.from.h - 1e-9 && stroke.at(0.5).h <= stroke.to.h + 1e-9;
}

bool Maker::add_line(double du, double dh) {
    const Place from = job_.contour.last();
    const Place to = rounded({from.u + du, from.h + dh});
    if (span(from, to) < 0.05 || to.h < 0.6 || to.h > 40.0) {
        return false;
    }
    push({from, to, false, {}, false});
    return true;
}

/// True if an arc only moves forward along the cut from its start.
bool isForward(const Stroke &arc) {
    const bool isValley = arc.isCounterclockwise;
    const auto isRight = [&](Place p) {
        return isValley ? p.h <= arc.centre.h + 1e-6 : p.h >= arc.centre.h - 1e-6;
    };
    return isRight(arc.from) && isRight(arc.to) && arc.turned(arc.to) < 3.1;
}

bool Maker::add_arc(double du, double dh) {
    Stroke arc;
    arc.isArc = true;
    arc.from = job_.contour.last();
    arc.to = rounded({arc.from.u + du, arc.from.h + dh});
    const double chord = span(arc.from, arc.to);
    if (chord < 0.2 || arc.to.u <= arc.from.u || arc.to.h < 0.6 || arc.to.h > 40.0) {
        return false;
    }
    arc.isCounterclockwise = chance(0.5);
    double radius = chord / 2.0 * number(1.02, 4.0);
    const bool isByRadius = chance(0.3);
    if (isByRadius) {
        const double unit = std::pow(10.0, digits_) / (job_.isInch ? MM_PER_INCH : 1.0);
        radius = std::ceil(radius * unit) / unit;
    }
    const double aside =
        std::sqrt(radius * radius - chord * chord / 4.0) * (arc.isCounterclockwise ? 1.0 : -1.0) / chord;
    const Place centre{(arc.from.u + arc.to.u) / 2.0 - aside * (arc.to.h - arc.from.h),
                       (arc.from.h + arc.to.h) / 2.0 + aside * (arc.to.u - arc.from.u)};
    arc.centre = isByRadius ? centre : rounded(centre);
    if (!isForward(arc) || arc.at(0.5).h < 0.6) {
        return false;
    }
    push(arc);
    if (isByRadius) {
        radii_[job_.contour.strokes.size()] = radius;
    }
    return true;
}

/// An arc of up to 90 degrees that is tangent to the end of the contour.
bool Maker::add_tangent_arc() {
    const Stroke &last = job_.contour.strokes.back();
    const Place before = last.at(1.0 - 1e-6), from = last.to;
    const double length = span(before, from);
    const double cu = (from.u - before.u) / length, ch = (from.h - before.h) / length;
    Stroke arc;
    arc.isArc = true;
    arc.from = from;
    arc.isCounterclockwise = chance(0.5);
    const double side = arc.isCounterclockwise ? 1.0 : -1.0, radius = number(0.3, 6.0);
    arc.centre = rounded({from.u - ch * side * radius, from.h + cu * side * radius});
    const double most = (arc.isCounterclockwise ? 1.0 : -1.0) * std::numbers::pi / 2.0;
    const double angle = arc.angle_of(from);
    const double turn = chance(0.4) ? most : most * number(0.2, 1.0);
    arc.to = rounded({arc.centre.u + arc.radius() * std::cos(angle + turn),
                      arc.centre.h + arc.radius() * std::sin(angle + turn)});
    const bool isOff = std::fabs(span(arc.centre, arc.to) - arc.radius()) > 0.01;
    if (isOff || arc.to.h < 0.6 || arc.to.h > 40.0 || arc.to.u <= arc.from.u || !isForward(arc) ||
        arc.at(0.5).h < 0.6) {
        return false;
    }
    push(arc);
    return true;
}

void Maker::make_contour() {
    const bool isRisingOnly = chance(0.4);
    const int count = 2 + pick(9);
    const double arcs = chance(0.5) ? 0.4 : 0.0;
    const Place first = rounded({0.0, number(1.0, isRisingOnly ? 8.0 : 16.0)});
    job_.isMonotonic = true;
    Stroke begin{first, first, false, {}, false};
    job_.contour.strokes.push_back(begin);  // until another cycle
    bool isUpright = false;
    for (int tries = 0; tries < 400 && static_cast<int>(job_.contour.strokes.size()) <= count; ++tries) {
        const double fall = isRisingOnly ? 0.0 : -number(0, 6);
        const double dh = isRisingOnly || chance(0.5) ? number(0, 6) : fall;
        const int kind = pick(10);
        const Contour before = job_.contour;
        const bool wasMonotonic = job_.isMonotonic;
        const bool isFirst = job_.contour.strokes.size() == 1;
        bool isAdded = false;
        if (chance(arcs)) {
            isAdded = isFirst || chance(0.5) ? add_arc(number(0.3, 8), dh) : add_tangent_arc();
        } else if (kind < 3) {
            isAdded = add_line(number(0.3, 8), 0.0);
        } else if (kind < 5) {
            isAdded = !isUpright && add_line(0.0, dh);
        } else {
            isAdded = add_line(number(0.1, 8), dh);
        }
        if (isAdded && isRisingOnly && !job_.isMonotonic) {
            job_.contour = before;
            job_.isMonotonic = wasMonotonic;
            continue;
        }
        isUpright = isAdded ? job_.contour.strokes.back().to.u - job_.contour.strokes.back().from.u < 1e-9
                            : isUpright;
    }
    const Stroke &end = job_.contour.strokes.back();
    if (end.to.h < end.from.h && end.to.u - end.from.u < 0.02) {  // no width is left to be turned
        job_.contour.strokes.pop_back();
    }
    if (job_.contour.strokes.size() == 1) {
        push({first, rounded({5.0, first.h}), false, {}, false});
    }
    job_.contour.strokes.erase(job_.contour.strokes.begin());
}

void Maker::choose_start() {
    const double top = job_.contour.highest(), first = job_.contour.first().h;
    double h = top + number(0.2, 8.0);
    if (chance(0.15) && top > first + 0.5) {  // part of the contour is above the start
        h = number(first + 0.3, top);
    }
    double ahead = chance(0.25) ? 0.0 : number(0.0, 4.0);
    if (h > top + 3.0 && chance(0.2)) {  // above the material
        ahead = -number(0.0, job_.contour.last().u);
    }
    job_.start = rounded({job_.contour.first().u - ahead, h});
}

double number_of_layers(const LatheJob &job, double step) {
    return (job.start.h - job.contour.first().h) / step;
}

void Maker::choose_cycles() {
    const std::string base = job_.isFacing ? "72" : "71";
    const double unit = job_.isInch ? MM_PER_INCH / 1e4 : 1e-3;
    const auto round = [&](double mm) { return std::round(mm / unit) * unit; };
    const double kind = number(0, 1);
    const double allowance =
        round(chance(0.15) ? 0.0 : (chance(0.5) ? number(0.02, 0.5) : number(0.02, 3.0)));
    double step = round(number(0.2, 4.0));
    while (number_of_layers(job_, step) > 60.0) {
        step = round(step * 2.0);
    }
    if (chance(0.5)) {
        job_.cycles.push_back({base, allowance, step, false, false});
    } else {
        const double more = round(chance(0.5) ? 0.0 : number(0.0, step));
        job_.cycles.push_back({base + ".1", allowance + more, step, true, false});
        if (kind < 0.8) {
            job_.cycles.push_back({base + ".2", allowance, step, false, false});
        }
    }
    if (chance(0.5) && !job_.cycles.back().isPocketLeft) {
        const double before = job_.cycles.back().allowance;
        job_.cycles.push_back({"70", chance(0.3) ? round(number(0.0, before)) : 0.0, before, false, true});
    }
}

std::string Maker::word(char letter, double program_units) const {
    return fmt::format("{}{:.{}f}", letter, program_units, digits_);
}

std::string Maker::words_to(Place p, Place from, bool isAll) const {
    double z = 0, x = 0, z0 = 0, x0 = 0;
    job_.machine(p, z, x);
    job_.machine(from, z0, x0);
    const double scale = job_.isDiameter ? 2.0 : 1.0;
    std::string out;
    if (isAll || std::fabs(x - x0) > 1e-7) {
        out += " " + word('X', to_program(x) * scale);
    }
    if (isAll || std::fabs(z - z0) > 1e-7) {
        out += " " + word('Z', to_program(z));
    }
    return out;
}

std::string Maker::arc_words(const Stroke &arc, std::size_t number) {
    double z = 0, x = 0, cz = 0, cx = 0;
    job_.machine(arc.from, z, x);
    job_.machine(arc.centre, cz, cx);
    const bool isCounterclockwise = arc.isCounterclockwise == job_.isSameTurn();
    const char *code = isCounterclockwise ? "G3" : "G2";
    if (const auto radius = radii_.find(number); radius != radii_.end()) {
        return fmt::format("{}{} R{:.6f}", code, words_to(arc.to, arc.from, true),
                           to_program(radius->second));
    }
    // Exact in the unit of the program, in diameter and in radius mode.
    return fmt::format("{}{} I{:.6f} K{:.6f}", code, words_to(arc.to, arc.from, true), to_program(cx - x),
                       to_program(cz - z));
}

std::string Maker::cycle_words(const JobCycle &cycle, bool hasStart) {
    std::string out = fmt::format("G{} Q100", cycle.code);
    out += hasStart ? words_to(job_.start, job_.start, true) : "";
    if (cycle.isFinishing) {
        if (cycle.allowance > 0.0 || (chance(0.5) && cycle.step > 0.0)) {
            out += fmt::format(" D{:.5f} E{:.5f} P{}", to_program(cycle.step), to_program(cycle.allowance),
                               1 + pick(3));
        }
        return out;
    }
    if (cycle.allowance > 0.0) {
        out += fmt::format(" D{:.5f}", to_program(cycle.allowance));
    }
    out += fmt::format(" I{:.5f}", to_program(cycle.step));
    if (chance(0.8)) {
        out += fmt::format(" R{:.4f}", to_program(number(0.0, 2.0)));
    }
    return out;
}

LatheJob Maker::make() {
    choose_frame();
    make_contour();
    choose_start();
    choose_cycles();
    const bool isAbove = job_.start.u > job_.contour.first().u;
    if (isAbove && job_.start.h < job_.contour.highest() + job_.largest_allowance() + 0.1) {
        job_.start =
            rounded({job_.contour.first().u - 1.0, job_.start.h});  // the point is within the allowance
    }
    static constexpr const char *OUTSIDE[] = {"G80\n", "G0\n", "G1\n", ""};
    std::string &out = job_.program;
    out = fmt::format("{} {} G18 G90 G94 F100\n{}O100 sub\n", job_.isInch ? "G20" : "G21",
                      job_.isDiameter ? "G7" : "G8", OUTSIDE[pick(4)]);
    static constexpr const char *FIRST[] = {"G0", "G1", ""};
    out += FIRST[pick(3)] + words_to(job_.contour.first(), job_.start, chance(0.8)) + "\n";
    for (std::size_t i = 0; i < job_.contour.strokes.size(); ++i) {
        const Stroke &stroke = job_.contour.strokes[i];
        // The contour had one more stroke when the arc was created.
        out += stroke.isArc ? arc_words(stroke, i + 2) : "G1" + words_to(stroke.to, stroke.from, false);
        out += "\n";
    }
    out += "O100 endsub\nG0" + words_to(job_.start, job_.start, true) + "\n";
    const double clear = job_.contour.highest() + job_.largest_allowance() + 10.0;
    for (std::size_t i = 0; i < job_.cycles.size(); ++i) {
        if (i > 0) {  // retracts from the part, moves along it, returns to the start
            const char across = job_.isFacing ? 'Z' : 'X', along = job_.isFacing ? 'X' : 'Z';
            double z = 0, x = 0;
            job_.machine({job_.start.u, clear}, z, x);
            const auto axis = [&](char name) {
                const double mm = name == 'Z' ? z : x * (job_.isDiameter ? 2.0 : 1.0);
                return word(name, to_program(mm));
            };
            out += fmt::format("G0 {}\n{}\n", axis(across), axis(along));
        }
        out += "G4 P0\n" + cycle_words(job_.cycles[i], i > 0 || chance(0.3)) + "\n";
    }
    return job_;
}

}  // namespace

Place LatheJob::place(double z, double x) const {
    const double along = isFacing ? x : z, across = isFacing ? z : x;
    return {(along - along_origin) * along_sign, (across - across_origin) * across_sign};
}

void LatheJob::machine(Place p, double &z, double &x) const {
    const double along = p.u * along_sign + along_origin, across = p.h * across_sign + across_origin;
    z = isFacing ? across : along;
    x = isFacing ? along : across;
}

double LatheJob::largest_allowance() const {
    double most = 0;
    for (const JobCycle &cycle : cycles) {
        most = std::max(most, cycle.allowance);
    }
    return most;
}

LatheJob make_lathe_job(unsigned seed) {
    return Maker(seed).make();
}

}  // namespace mw::testing

// SPDX-License-Identifier: GPL-2.0-or-later
#include "lathe_campaign.hh"

#include <fmt/format.h>

#include "gcode/canon/machine_frame.hh"
#include "gcode/interpreter/interpreter.hh"
#include "mill.hh"
#include "tests/support/stock/lathe_stock.hh"

namespace mw::gcode::test {
namespace {

/// The moves of the cycles in machine coordinates, in order; a dwell precedes each cycle.
class CycleRecorder : public MachineCanon {
  public:
    struct Move {
        bool isRapid = false, isArc = false;
        double z = 0, x = 0, centre_z = 0, centre_x = 0, angle = 0;
    };
    std::vector<std::vector<Move>> cycles;
    double z = 0, x = 0;  ///< tool position before the first move

    void begin_block(const BlockRef &) override {}
    void take(const MachineCall &call) override {
        if (const auto *move = std::get_if<LineMove>(&call)) {
            line(*move);
        } else if (const auto *turn = std::get_if<ArcMove>(&call)) {
            arc(*turn);
        } else if (std::holds_alternative<Dwell>(call)) {
            cycles.emplace_back();
        }
    }

  private:
    void line(const LineMove &move) {
        add({move.settings.isRapid, false, move.end[geometry::AXIS_Z], move.end[geometry::AXIS_X], 0, 0, 0});
    }
    void arc(const ArcMove &move) {
        // The normal of G18 is Y: positive angles are from Z to X.
        add({false, true, move.end[geometry::AXIS_Z], move.end[geometry::AXIS_X],
             move.centre[geometry::AXIS_Z], move.centre[geometry::AXIS_X],
             move.angle_rad * (move.normal[geometry::AXIS_Y] < 0.0 ? -1.0 : 1.0)});
    }
    void add(const Move &move) {
        if (cycles.empty()) {
            z = move.z;
            x = move.x;
        } else {
            cycles.back().push_back(move);
        }
    }
};

/// The error text without numbers, so that rejections for the same reason have the same text.
std::string without_figures(const std::string &error) {
    std::string out;
    for (const char c : error.substr(0, error.find('\n'))) {
        out += std::isdigit(static_cast<unsigned char>(c)) != 0 ? '#' : c;
    }
    return out;
}

}  // namespace

LatheVerdict run_lathe_job(const testing::LatheJob &job) {
    LatheVerdict verdict;
    CycleRecorder record;
    Mill mill;
    for (int number = 1; number <= 3; ++number) {
        mill.tools.emplace_back();
        mill.tools.back().toolno = number;
    }
    MachineFrame frame(record, mill.units);
    Settings settings;
    settings.statement_budget = 1000000;
    Interpreter interpreter(frame, mill, mill, mill, settings);
    if (const Result<> begun = interpreter.begin(); !begun) {
        verdict.refusal = begun.error().message;
        return verdict;
    }
    interpreter.open_text("job.ngc", job.program + "M2\n");
    Step step = Step::OK;
    while (step == Step::OK || step == Step::SYNC) {
        if (step == Step::SYNC) {
            mill.state.position = frame.position();
            interpreter.synch();
        }
        step = interpreter.step();
    }
    if (step != Step::PROGRAM_END) {
        verdict.refusal = without_figures(interpreter.error().what.message);
        return verdict;
    }
    for (const auto &moves : record.cycles) {
        testing::Place last;
        for (const CycleRecorder::Move &one : moves) {
            last = one.isRapid ? last : job.place(one.z, one.x);
        }
        verdict.last_places.push_back(last);
    }
    testing::LatheStock stock(job.contour, job.start.h, job.largest_allowance() + 1.0);
    testing::Place at = job.place(record.z, record.x);
    double skin = 0;
    for (std::size_t i = 0; i < job.cycles.size(); ++i) {
        const testing::JobCycle &cycle = job.cycles[i];
        testing::CutRules rules;
        rules.allowance = cycle.allowance;
        rules.step = cycle.isFinishing ? 0.0 : cycle.step;
        rules.skin = skin;
        for (const CycleRecorder::Move &one : record.cycles[i]) {
            testing::StockMove move;
            move.isRapid = one.isRapid;
            move.path = {at, job.place(one.z, one.x), one.isArc, job.place(one.centre_z, one.centre_x),
                         (one.angle > 0.0) == job.isSameTurn()};
            verdict.fault = stock.cut(move, rules);
            if (!verdict.fault.empty()) {
                verdict.fault = fmt::format("G{}: {}", cycle.code, verdict.fault);
                return verdict;
            }
            at = move.path.to;
            ++verdict.moves;
        }
        // Material on the face at the contour's end, which G71.1 leaves for G71.2, and G71 for G70.
        skin = cycle.allowance;
        const double end_allowance = std::fmax(cycle.allowance, 0.0);
        const std::string left = stock.unfinished(cycle.allowance, cycle.isPocketLeft, end_allowance);
        if (!left.empty()) {
            verdict.fault = fmt::format("G{}: {}", cycle.code, left);
            return verdict;
        }
    }
    return verdict;
}

}  // namespace mw::gcode::test

// SPDX-License-Identifier: GPL-2.0-or-later
#include "power_cut/programs.hh"

#include <fmt/format.h>

namespace mw::power_cut {
namespace {

class Writer {
  public:
    explicit Writer(std::mt19937_64 &random) : random_(random) {}

    int whole(int low, int high) {
        return low + static_cast<int>(random_() % static_cast<unsigned>(high - low + 1));
    }
    double number(int low, int high) { return whole(low * 1000, high * 1000) / 1000.0; }
    bool chance(int of) { return random_() % static_cast<unsigned>(of) == 0; }

    /// Straight moves and arcs that are connected to each other.
    std::string contour() {
        std::string out = fmt::format("G1 Z{:.3f}\n", number(-4, 1));
        for (int i = whole(3, 12); i > 0; --i) {
            const double r = number(1, 6);
            out += chance(3)
                       ? fmt::format("G91 G{} X{:.4f} Y{:.4f} I{:.4f}\nG90\n", whole(2, 3), r, 0.0, r / 2)
                       : fmt::format("G1 X{:.4f} Y{:.4f}\n", number(-20, 20), number(-20, 20));
        }
        return out + "G0 Z5\n";
    }
    std::string cycles() {
        const bool isPeck = chance(2);
        std::string out = fmt::format("G{} G{} X{:.3f} Y{:.3f} Z{:.3f} R{:.3f} {}\n", whole(98, 99),
                                      isPeck ? 83 : 82, number(-9, 9), number(-9, 9), number(-6, -3),
                                      number(1, 3), isPeck ? "Q1.5" : "P0.02");
        for (int i = whole(1, 4); i > 0; --i) {
            out += fmt::format("X{:.3f} Y{:.3f}\n", number(-20, 20), number(-20, 20));
        }
        return out + "G80\n";
    }
    /// A square with the tool at its side.
    std::string compensated() {
        const double a = number(10, 18);
        return fmt::format("G0 X0 Y0 Z2\nG41.1 D{:.3f} G1 X{:.4f} Y-2\nY{:.4f}\nG3 X{:.4f} Y{:.4f} R2\nG1 "
                           "X{:.4f}\nY{:.4f}\nX{:.4f}\nG40 G1 X0 Y0\n",
                           number(1, 2), a, a - 2, a - 2, a, -a, -a, a);
    }
    std::string loop() {
        ++label_;
        const std::string counter = chance(2) ? "#<n>" : "#<_n>";
        return fmt::format("{0} = 0\no{1} while [{0} LT {2}]\n G1 X[{0} * {3:.3f}] Y[SIN[{0} * 40] * 8]\n "
                           "{0} = [{0} + 1]\no{1} endwhile\n",
                           counter, label_, whole(3, 10), number(1, 3));
    }
    std::string call() { return fmt::format("o<cut> call [{:.3f}] [{:.3f}]\n", number(2, 9), number(-9, 9)); }
    std::string modes() {
        switch (whole(0, 9)) {
        case 0: return fmt::format("G64 P{:.3f}\n", number(0, 1));
        case 1: return "G61\n";
        case 2: return fmt::format("G{}\n", whole(54, 57));
        case 3:
            return fmt::format("G10 L2 P{} X{:.3f} Z{:.3f} R{}\n", whole(1, 4), number(-4, 4), number(0, 2),
                               whole(0, 30));
        case 4: return fmt::format("G92 X{:.3f}\n", number(-5, 5));
        case 5: return fmt::format("F{}\n", whole(1500, 6000));
        case 6: return fmt::format("S{} M{}\n", whole(300, 2000), whole(3, 4));
        case 7: return chance(2) ? "M8\n" : "M7\n";
        case 8: return fmt::format("G20\nG91 G1 X{:.4f} F90\nG90\nG21 F2000\n", number(0, 1));
        default: return fmt::format("M{} P{}\nG4 P{:.3f}\n", whole(64, 65), whole(0, 3), number(0, 1) / 5);
        }
    }
    std::string tool() {
        const int number = whole(1, 5);
        return fmt::format("T{} M6\nG43\nS{} M3\n{}G0 Z5\n", number, whole(400, 1500),
                           chance(3) ? fmt::format("T{}\n", whole(1, 5)) : std::string());
    }
    std::string section() {
        switch (whole(0, 9)) {
        case 0:
        case 1: return contour();
        case 2: return cycles();
        case 3: return compensated();
        case 4: return loop();
        case 5: return call();
        case 6: return tool();
        case 7: return fmt::format("#{} = [#{} + {:.3f}]\n", whole(31, 40), whole(31, 40), number(-3, 3));
        default: return modes();
        }
    }

  private:
    std::mt19937_64 &random_;
    int label_ = 100;
};

}  // namespace

Job make_job(std::mt19937_64 &random) {
    Writer make(random);
    Job job;
    for (int i = make.whole(0, 3); i > 0; --i) {
        const std::string lines = make.modes();
        job.mdi.push_back(lines.substr(0, lines.find('\n')));
    }
    job.program =
        "o<cut> sub\n G1 X[#1] Y[#2]\n o50 repeat [3]\n  G91 G1 X1.1 Y-0.7\n  G90\n o50 endrepeat\n "
        "#33 = [#33 + #1]\no<cut> endsub\nG21 G90 G94 F3000\nG0 Z5\n";
    for (int i = make.whole(5, 16); i > 0; --i) {
        job.program += make.section();
    }
    job.program += "G0 Z10\nM5 M9\nM2\n";
    return job;
}

}  // namespace mw::power_cut

// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "gcode/analysis/format.hh"

namespace mw::gcode {
namespace {

void expect_format(const std::string &from, const std::string &to) {
    EXPECT_EQ(format_program(from), to);
    EXPECT_EQ(format_program(to), to) << "formatting twice";
}

TEST(Format, WritesWordsInOneForm) {
    expect_format("g01x 1.50y-.5  z0f1 00", "G1 X1.5 Y-0.5 Z0 F100");
    expect_format("n0010 G 38.20 Z-5 (probe)M3", "N10 G38.2 Z-5 M3 (probe)");
    expect_format("/ g0 x+3 @5 ^30 s200$1", "/G0 X3 @5 ^30 S200 $1");
    expect_format("G0 X-0 Y1000000000000 Z.0000001", "G0 X-0 Y1000000000000 Z0.0000001");
    expect_format("", "");
    expect_format("  \r\n\n(only this)  \nG0X1;to the end  \r\n", "\n\n(only this)\nG0 X1 ;to the end\n");
    expect_format("%  part 7\nM2\n%", "%  part 7\nM2\n%");
    expect_format("G0 X[[1", "G0 X[[1");
}

TEST(Format, KeepsTheValueOfExpressions) {
    expect_format("#1=[1+[2*3]]", "#1 = [1 + 2 * 3]");
    expect_format("#1=[[1+2]*3] #<A b>=#1", "#1 = [[1 + 2] * 3] #<A b> = #1");
    expect_format("#[1+1]=-sin[30]", "#[1 + 1] = -[SIN[30]]");
    expect_format("X[1-[2-3]]Y[[1-2]-3]", "X[1 - [2 - 3]] Y[1 - 2 - 3]");
    expect_format("X[2**[3**2]] Y[-2**2] Z[-[1+2]]", "X[2 ** [3 ** 2]] Y[-2 ** 2] Z-[1 + 2]");
    expect_format("X[atan[1]/[2]/3] Y##1 Z-#<_x>", "X[ATAN[1]/[2] / 3] Y##1 Z-#<_x>");
    expect_format("X[1 lt 2and 3gt4] A[exists[#<a>]] B[exists[#5]]",
                  "X[1 LT 2 AND 3 GT 4] A[EXISTS[#<a>]] B[EXISTS[#5]]");
}

TEST(Format, IndentsWhatOWordsEnclose) {
    expect_format(
        "O<Drill> SUB (hole)\nG0Z#1\no100if[#1gt0]\no101repeat[3]\nG1X1\no101endrepeat\no100elseif[1]\n"
        "G4P1\no100 else\nG4P2\nO100endif\no<Drill> endsub[2]\no<Drill>call[5](five)[6]\nM2\n",
        "o<Drill> sub (hole)\n    G0 Z#1\n    o100 if [#1 GT 0]\n        o101 repeat [3]\n"
        "            G1 X1\n        o101 endrepeat\n    o100 elseif [1]\n        G4 P1\n    o100 else\n"
        "        G4 P2\n    o100 endif\no<Drill> endsub [2]\no<Drill> call [5] [6] (five)\nM2\n");
    expect_format(
        "o1do\n#1=1\no1while[#1lt3]\no2while[1]\no2break\no2endwhile\nO7\nM99\n",
        "o1 do\n    #1 = 1\no1 while [#1 LT 3]\no2 while [1]\n    o2 break\no2 endwhile\no7\nM99\n");
    expect_format("o[#1+1] call [1]", "o[#1 + 1] call [1]");
}

}  // namespace
}  // namespace mw::gcode

// SPDX-License-Identifier: GPL-2.0-or-later
// Tests every switchable kinematics as a loaded module: switches to each type and back with M68 and M66, and
// moves in each. Joints are stopped while the type changes (the judge of VirtualMachineTest detects steps).
// With identity kinematics, joints are axes. The pin shows the type.
#include <cmath>

#include "sim/machine_file.hh"
#include "sim/virtual_machine.hh"

namespace mw::machine {
namespace {

enum class Kind { MODEL, IDENTITY, NONE };

struct Switched {
    const char *name;
    const char *kinematics;  ///< with its arguments
    const char *letters;     ///< of the joints in identity
    std::vector<double> home;
    std::vector<Kind> types;
    const char *hal = "";
    const char *coordinates = "";  ///< [TRAJ]COORDINATES; the letters when empty
};

void PrintTo(const Switched &one, std::ostream *out) {
    *out << one.name;
}

const std::vector<Kind> MODEL_FIRST{Kind::MODEL, Kind::IDENTITY, Kind::IDENTITY};
const std::vector<Kind> IDENTITY_FIRST{Kind::IDENTITY, Kind::MODEL, Kind::IDENTITY};

class Switching : public VirtualMachineTest, public ::testing::WithParamInterface<Switched> {
  protected:
    void SetUp() override {
        const Switched &one = GetParam();
        SimMachine machine;
        machine.coordinates = *one.coordinates != '\0' ? one.coordinates : one.letters;
        machine.kinematics = one.kinematics;
        machine.axis_range = 2000;
        machine.hal_lines =
            std::string("net kind motion.analog-out-03 => motion.switchkins-type\n") + one.hal;
        machine.joints.clear();
        for (std::size_t j = 0; j < one.home.size(); ++j) {
            const bool isAngular = one.letters[j] >= 'A' && one.letters[j] <= 'C';
            SimJoint joint{isAngular, 200, 1500, -2000, 2000, 0};
            joint.home = one.home[j];
            machine.joints.push_back(joint);
        }
        switch_on_config(machine.write(folder_));
    }
    std::vector<double> joints() {
        std::vector<double> out;
        for (std::size_t j = 0; j < GetParam().home.size(); ++j) {
            out.push_back(motion().joint[j].pos_cmd);
        }
        return out;
    }
    void expect_joints(const std::vector<double> &expected) {
        for (std::size_t j = 0; j < expected.size(); ++j) {
            EXPECT_NEAR(motion().joint[j].pos_cmd, expected[j], 1e-6) << "joint " << j;
        }
    }
    task::Progress change(int type) {
        const task::Progress done = mdi(fmt::format("M68 E3 Q{}", type));
        return done == task::Progress::DONE ? mdi("M66 E0 L0") : done;
    }
    static int axis_of(char letter) { return static_cast<int>(std::string_view("XYZABCUVW").find(letter)); }
    bool isType(int type) {
        const auto pin = machine_->hal().values().get(fmt::format("kinstype.is-{}", type));
        return pin.has_value() && pin->as_number() != 0;
    }
    void expect_identity() {
        const std::string letters = GetParam().letters;
        for (std::size_t j = 0; j < letters.size(); ++j) {
            EXPECT_NEAR(motion().carte_pos_cmd[axis_of(letters[j])], motion().joint[j].pos_cmd, 1e-9) << j;
        }
        const std::vector<double> from = joints();
        ASSERT_EQ(mdi(fmt::format("G91 G1 {}2 F6000", letters[0])), task::Progress::DONE) << messages();
        ASSERT_EQ(mdi("G90"), task::Progress::DONE);
        std::vector<double> expected = from;
        expected[0] += 2;
        expect_joints(expected);
        ASSERT_EQ(mdi(fmt::format("G91 G1 {}-2 F6000", letters[0])), task::Progress::DONE) << messages();
        ASSERT_EQ(mdi("G90"), task::Progress::DONE);
        expect_joints(from);
    }
    /// A move of 2 units in X and back in the active model, from any position.
    void expect_model() {
        const std::vector<double> from = joints();
        const double x = motion().carte_pos_cmd[0];
        ASSERT_EQ(mdi("G91 G1 X2 F6000"), task::Progress::DONE) << messages();
        EXPECT_NEAR(motion().carte_pos_cmd[0], x + 2, 1e-6);
        ASSERT_EQ(mdi("G1 X-2"), task::Progress::DONE) << messages();
        ASSERT_EQ(mdi("G90"), task::Progress::DONE);
        expect_joints(from);
    }
};

TEST_P(Switching, ToEachTypeAndBackWithoutAStep) {
    const std::vector<Kind> &types = GetParam().types;
    EXPECT_TRUE(isType(0));
    // From each type to each other type.
    for (const int type : {0, 1, 2, 1, 0, 2, 0, 3}) {
        SCOPED_TRACE(type);
        const Kind kind = type < 3 ? types[static_cast<std::size_t>(type)] : Kind::NONE;
        const std::vector<double> before = joints();
        const bool isDone = change(type) == task::Progress::DONE;
        expect_joints(before);
        if (kind == Kind::NONE) {
            EXPECT_NE(messages().find(fmt::format("no type {}", type)), std::string::npos) << messages();
            ASSERT_EQ(change(0), task::Progress::DONE) << messages();
            continue;
        }
        ASSERT_TRUE(isDone) << messages();
        EXPECT_TRUE(isType(type));
        if (kind == Kind::IDENTITY) {
            expect_identity();
        } else {
            expect_model();
        }
    }
    EXPECT_EQ(judge_.report(), "");
}

const std::vector<double> ARM{10, -40, 20, 20, 30, 40};

INSTANTIATE_TEST_SUITE_P(
    All, Switching,
    ::testing::Values(
        Switched{"xyzac", "xyzac-trt-kins", "XYZAC", {1, 2, 3, 20, 30}, MODEL_FIRST},
        Switched{"xyzac_identity_first",
                 "xyzac-trt-kins sparm=identityfirst",
                 "XYZAC",
                 {1, 2, 3, 20, 30},
                 IDENTITY_FIRST},
        Switched{"xyzbc", "xyzbc-trt-kins", "XYZBC", {1, 2, 3, 20, 30}, MODEL_FIRST},
        Switched{"xyzbc_identity_first",
                 "xyzbc-trt-kins sparm=identityfirst",
                 "XYZBC",
                 {1, 2, 3, 20, 30},
                 IDENTITY_FIRST},
        Switched{"xyzac_other_order",
                 "xyzac-trt-kins coordinates=CAXYZ",
                 "CAXYZ",
                 {30, 20, 1, 2, 3},
                 MODEL_FIRST,
                 "",
                 "XYZAC"},
        Switched{
            "xyzab", "xyzab_tdr_kins", "XYZAB", {1, 2, 3, 20, 30}, {Kind::IDENTITY, Kind::MODEL, Kind::NONE}},
        Switched{"xyzacb",
                 "xyzacb_trsrn",
                 "XYZABC",
                 {1, 2, 3, 20, 30, 40},
                 {Kind::IDENTITY, Kind::MODEL, Kind::MODEL},
                 "setp xyzacb_trsrn_kins.nut-angle 55\nsetp xyzacb_trsrn_kins.z-pivot 120\n"
                 "setp xyzacb_trsrn_kins.primary-angle 40\nsetp xyzacb_trsrn_kins.secondary-angle 30\n"},
        Switched{"xyzbca",
                 "xyzbca_trsrn",
                 "XYZABC",
                 {1, 2, 3, 20, 30, 40},
                 {Kind::IDENTITY, Kind::MODEL, Kind::MODEL},
                 "setp xyzbca_trsrn_kins.nut-angle 45\nsetp xyzbca_trsrn_kins.x-pivot 50\n"
                 "setp xyzbca_trsrn_kins.primary-angle 40\nsetp xyzbca_trsrn_kins.secondary-angle 20\n"},
        Switched{"bridge", "5axiskins", "XYZBCW", {1, 2, 3, 20, 30, 4}, MODEL_FIRST},
        Switched{"scara", "scarakins", "XYZABC", {30, 60, 10, 5, 0, 0}, MODEL_FIRST},
        Switched{"scara_identity_first",
                 "scarakins sparm=identityfirst",
                 "XYZABC",
                 {30, 60, 10, 5, 0, 0},
                 IDENTITY_FIRST},
        Switched{"puma", "pumakins", "XYZABC", ARM, MODEL_FIRST},
        Switched{"genser", "genserkins", "XYZABC", ARM, MODEL_FIRST},
        Switched{"three21", "three21kins", "XYZABC", ARM, MODEL_FIRST},
        Switched{"hexapod", "genhexkins", "XYZABC", std::vector<double>(6, 29.7467), MODEL_FIRST,
                 "setp genhexkins.z 18\n"},
        Switched{"mill_turn", "millturn", "XYZA", {1, 2, 3, 20}, {Kind::IDENTITY, Kind::MODEL, Kind::NONE}}),
    [](const auto &one) { return std::string(one.param.name); });

}  // namespace
}  // namespace mw::machine

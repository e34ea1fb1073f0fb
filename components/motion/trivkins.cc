// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of machines whose joints are axes. coordinates=XYYZ: joint n drives the n-th letter.
// kinstype=1 identity (default), both: joints and axes differ for operators (gantries), f: forward only, i:
// inverse only.
#include "components/motion/kinematics_module.hh"
#include "kinematics/trivial.hh"

static char *coordinates;
RTAPI_MP_STRING(coordinates, "axis letters in the order of the joints");
static char *kinstype;
RTAPI_MP_STRING(kinstype, "1 identity, b both, f forward only, i inverse only");

static mw::kinematics::Trivial model;
static KINEMATICS_TYPE type = KINEMATICS_IDENTITY;
static int component = -1;

MW_KINEMATICS(model);

extern "C" KINEMATICS_TYPE kinematicsType(void) {
    return type;
}

/// Each joint is an axis, with any kinstype=.
extern "C" RTAPI_EXPORT int mw_kinematics_is_identity(void) {
    return 1;
}

int rtapi_app_main(void) {
    const char *letters = coordinates != nullptr && coordinates[0] != '\0' ? coordinates : "XYZABCUVW";
    if (!model.configure(letters)) {
        rtapi_print_msg(RTAPI_MSG_ERR,
                        "trivkins: coordinates=%s: expected up to 16 of the letters XYZABCUVW\n", letters);
        return -22;  // EINVAL
    }
    switch (kinstype != nullptr ? kinstype[0] : '1') {
    case 'b':
    case 'B': type = KINEMATICS_BOTH; break;
    case 'f':
    case 'F': type = KINEMATICS_FORWARD_ONLY; break;
    case 'i':
    case 'I': type = KINEMATICS_INVERSE_ONLY; break;
    case '1':
    case '\0': type = KINEMATICS_IDENTITY; break;
    default:
        rtapi_print_msg(RTAPI_MSG_ERR, "trivkins: kinstype=%s: expected 1, both, f or i\n", kinstype);
        return -22;  // EINVAL
    }
    component = hal_init("trivkins");
    if (component < 0) {
        return component;
    }
    return hal_ready(component);
}

void rtapi_app_exit(void) {
    hal_exit(component);
}

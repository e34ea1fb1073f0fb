// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of five-axis machines with a tilting rotary table (kinematics/rotary_table.hh): joints 0 to 4 =
// X Y Z A C. tilt_y=, tilt_z=: the position where the axis A passes the axis C, from the origin [machine
// units].
#include <errno.h>
#include <stdlib.h>

#include "components/motion/kinematics_module.hh"
#include "kinematics/rotary_table.hh"

static char *tilt_y;
RTAPI_MP_STRING(tilt_y, "Y of the tilting axis [machine units]");
static char *tilt_z;
RTAPI_MP_STRING(tilt_z, "Z of the tilting axis [machine units]");

static mw::kinematics::RotaryTable model;

MW_KINEMATICS(model);

MW_KINEMATICS_PURE;

/// False when the text is not a number. The realtime process always uses the C locale.
static bool read_number(const char *name, const char *text, double &value) {
    if (text == nullptr || text[0] == '\0') {
        return true;
    }
    char *end = nullptr;
    value = strtod(text, &end);
    if (*end != '\0') {
        rtapi_print_msg(RTAPI_MSG_ERR, "tablekins: %s=%s: expected a number\n", name, text);
    }
    return *end == '\0';
}

static int read_arguments(int) {
    double y = 0;
    double z = 0;
    if (!read_number("tilt_y", tilt_y, y) || !read_number("tilt_z", tilt_z, z)) {
        return -EINVAL;
    }
    model.set_tilt_axis(y, z);
    return 0;
}

MW_KINEMATICS_MAIN("tablekins", read_arguments);

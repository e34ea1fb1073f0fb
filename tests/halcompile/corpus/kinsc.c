/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Kinematics in C: joints are axes, with y inverted. */
#include "hal.h"
#include "kinematics.h"
#include "rtapi.h"
#include "rtapi_app.h"

MODULE_LICENSE("GPL");
static int comp_id;
int kinematicsForward(const double *j, EmcPose *p, const KINEMATICS_FORWARD_FLAGS *f,
                      KINEMATICS_INVERSE_FLAGS *i) {
    (void)f;
    (void)i;
    p->tran.x = j[0];
    p->tran.y = -j[1];
    p->tran.z = j[2];
    return 0;
}
int kinematicsInverse(const EmcPose *p, double *j, const KINEMATICS_INVERSE_FLAGS *i,
                      KINEMATICS_FORWARD_FLAGS *f) {
    (void)f;
    (void)i;
    j[0] = p->tran.x;
    j[1] = -p->tran.y;
    j[2] = p->tran.z;
    return 0;
}
KINEMATICS_TYPE kinematicsType() {
    return KINEMATICS_BOTH;
}
KINS_NOT_SWITCHABLE
EXPORT_SYMBOL(kinematicsType);
EXPORT_SYMBOL(kinematicsInverse);
EXPORT_SYMBOL(kinematicsForward);
int rtapi_app_main(void) {
    comp_id = hal_init("kinsc");
    if (comp_id < 0) {
        return comp_id;
    }
    hal_ready(comp_id);
    return 0;
}
void rtapi_app_exit(void) {
    hal_exit(comp_id);
}

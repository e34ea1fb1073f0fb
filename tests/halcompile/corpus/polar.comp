// SPDX-License-Identifier: GPL-2.0-or-later
component polar "Kinematics of a turning arm: joint 0 is the radius, joint 1 the angle [deg]";
pin in float arm = 0;
function fdemo fp;
license "GPL"; // GPL-2.0-or-later
;;
#include <rtapi_math.h>
#include <kinematics.h>

KINS_NOT_SWITCHABLE
EXPORT_SYMBOL(kinematicsType);
EXPORT_SYMBOL(kinematicsForward);
EXPORT_SYMBOL(kinematicsInverse);

FUNCTION(fdemo) { (void)arm; }

KINEMATICS_TYPE kinematicsType(void) { return KINEMATICS_BOTH; }

int kinematicsForward(const double *j, EmcPose *pos, const KINEMATICS_FORWARD_FLAGS *fflags,
                      KINEMATICS_INVERSE_FLAGS *iflags) {
    (void)fflags; (void)iflags;
    pos->tran.x = j[0] * cos(j[1] * M_PI / 180);
    pos->tran.y = j[0] * sin(j[1] * M_PI / 180);
    pos->tran.z = j[2];
    return 0;
}

int kinematicsInverse(const EmcPose *pos, double *j, const KINEMATICS_INVERSE_FLAGS *iflags,
                      KINEMATICS_FORWARD_FLAGS *fflags) {
    (void)fflags; (void)iflags;
    j[0] = sqrt(pos->tran.x * pos->tran.x + pos->tran.y * pos->tran.y);
    j[1] = atan2(pos->tran.y, pos->tran.x) * 180 / M_PI;
    j[2] = pos->tran.z;
    return 0;
}

/* SPDX-License-Identifier: GPL-2.0-or-later */
/* A pose in nine coordinates, as kinematics modules see it. Lengths in machine units, angles in degrees. */
#ifndef EMCPOS_H
#define EMCPOS_H

typedef struct {
    double x, y, z;
} PmCartesian;

typedef struct EmcPose {
    PmCartesian tran;
    double a, b, c;
    double u, v, w;
} EmcPose;

#endif

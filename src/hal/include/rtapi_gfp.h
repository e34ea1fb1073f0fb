/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Types of memory that a caller can request; all have the same effect here. */
#ifndef RTAPI_GFP_H
#define RTAPI_GFP_H

enum rtapi_gfp_e {
    RTAPI_GFP_BUFFER,
    RTAPI_GFP_ATOMIC,
    RTAPI_GFP_KERNEL,
    RTAPI_GFP_USER,
    RTAPI_GFP_NOBUFFER,
    RTAPI_GFP_NFS,
    RTAPI_GFP_DMA
};
typedef enum rtapi_gfp_e rtapi_gfp_t;
#define rtapi_gpf_e rtapi_gfp_e
#define rtapi_gpf_t rtapi_gfp_t

#endif

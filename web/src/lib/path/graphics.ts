// SPDX-License-Identifier: GPL-2.0-or-later

/** True if the processor renders the graphics, so that each pixel costs time. */
export function isSoftware(): boolean {
  const gl = document.createElement('canvas').getContext('webgl2');
  const facts = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = facts === null || facts === undefined ? '' : String(gl?.getParameter(facts.UNMASKED_RENDERER_WEBGL));
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}

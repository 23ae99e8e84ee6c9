// The bodies as the shader takes them: place, colour, orientation and flash, for a time in frames.
const PALETTE = [[0.13, 0.47, 0.73], [0.87, 0.49, 0.16], [0.16, 0.6, 0.47], [0.72, 0.4, 0.62], [0.76, 0.63, 0.2]];
const BRIGHT = [[0.98, 0.5, 0.1], [0.15, 0.62, 0.95]];
/** A contact's flash lasts so many seconds of the playback. */
const FLASH = 0.35;

/** A body's colour: by its group, each body a little lighter or darker than the next. */
function colourOf(body) {
  const shade = 0.86 + 0.28 * ((body * 0.618034) % 1);
  return times(PALETTE[picture.groups[body] % PALETTE.length], shade);
}

/** Where nothing moves: bodies that touch are bright, the others faint, and those of the chosen contact brightest. */
function colourAtRest(body, chosen) {
  const isQuery = body >= picture.queries_from;
  if (!picture.contacts.length) return [...colourOf(body), 1];
  if (!inContact[body]) return [0.55, 0.58, 0.63, isQuery ? 0.1 : 0.3];
  const isChosen = chosen && (chosen[1] === body || chosen[2] === body);
  const tint = BRIGHT[isQuery ? 1 : 0];
  return [...(chosen && !isChosen ? times(tint, 0.6) : tint), 1];
}

/** How much each body flashes at a time: 1 in the frame in which a contact begins, then less. */
function flashes(time, framesPerSecond) {
  const glow = new Float32Array(bodyCount), lasting = Math.max(1, FLASH * framesPerSecond);
  let low = 0, high = meetings.length / 3;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (meetings[middle * 3] < time - lasting) low = middle + 1; else high = middle;
  }
  for (let i = low; i * 3 < meetings.length && meetings[i * 3] <= time; i++) {
    const [frame, first, second] = meetings.subarray(i * 3, i * 3 + 3), left = 1 - (time - frame) / lasting;
    if (frame === 0) continue;
    glow[first] = Math.max(glow[first], left);
    glow[second] = Math.max(glow[second], left);
  }
  return glow;
}

/** All bodies: solid ones, faint ones, and centre and radius of each. */
function bodiesAt(time, framesPerSecond, chosen) {
  const moves = picture.frames > 1, glow = flashes(time, framesPerSecond);
  const solid = [], faint = [], balls = new Float32Array(bodyCount * 4);
  for (let body = 0; body < bodyCount; body++) {
    const place = centre(body, time), radius = picture.radii[body];
    const colour = moves ? [...colourOf(body), 1] : colourAtRest(body, chosen);
    balls.set([...place, radius], body * 4);
    (colour[3] < 1 ? faint : solid).push(...place, radius, ...colour, ...orientation(body, time), glow[body]);
  }
  return { solid: new Float32Array(solid), faint: new Float32Array(faint), balls };
}

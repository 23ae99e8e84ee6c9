// The page's data: places and orientations of every body in every frame, meetings, contacts, and the room.
const picture = JSON.parse(document.getElementById("picture").textContent);
const bytesOf = (text) => Uint8Array.from(atob(text || ""), (letter) => letter.charCodeAt(0)).buffer;
const places = new Uint16Array(bytesOf(picture.places));
const turns = picture.turns ? new Int16Array(bytesOf(picture.turns)) : null;
const meetings = new Uint32Array(bytesOf(picture.meetings));
const bodyCount = picture.radii.length;
const lastFrame = picture.frames - 1;
const inContact = new Uint8Array(bodyCount);
for (const [, first, second] of picture.contacts) inContact[first] = inContact[second] = 1;

/** The coordinate of a body along an axis, at a time in frames: between two frames it lies on the line. */
function coordinate(body, axis, time) {
  const frame = Math.min(Math.floor(time), lastFrame), share = time - frame;
  const at = (f) => places[(f * bodyCount + body) * 3 + axis];
  const value = share > 0 ? at(frame) * (1 - share) + at(frame + 1) * share : at(frame);
  return picture.low[axis] + value / 65535 * picture.span;
}

const centre = (body, time) => [coordinate(body, 0, time), coordinate(body, 1, time), coordinate(body, 2, time)];

/** The orientation of a body at a time in frames: a unit quaternion, vector part first. */
function orientation(body, time) {
  if (!turns) return [0, 0, 0, 1];
  const at = (frame) => {
    const [x, y, z] = [0, 1, 2].map((part) => turns[(frame * bodyCount + body) * 3 + part] / 32767);
    return [x, y, z, Math.sqrt(Math.max(0, 1 - x * x - y * y - z * z))];
  };
  const frame = Math.min(Math.floor(time), lastFrame), share = time - frame, from = at(frame);
  if (!(share > 0)) return from;
  const to = at(frame + 1), sign = from.reduce((sum, part, i) => sum + part * to[i], 0) < 0 ? -1 : 1;
  const mixed = from.map((part, i) => part * (1 - share) + sign * to[i] * share), length = Math.hypot(...mixed);
  return length > 0 ? mixed.map((part) => part / length) : from;
}

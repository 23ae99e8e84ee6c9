// The ball that the camera keeps in view in every frame: around all bodies but stragglers, and smooth in time.
function ballsToFollow() {
  const window = Math.max(1, Math.round(picture.frames / 20));
  const frames = Array.from({ length: picture.frames }, (_, frame) => frame);
  const middles = smooth(frames.map(middleOf), window);
  const radii = frames.map((frame) => radiusAround(middles[frame], frame));
  // The widest of the neighbours first, so that what is smoothed cuts nothing off.
  const widest = radii.map((_, frame) => Math.max(...radii.slice(Math.max(0, frame - window), frame + window + 1)));
  const smoothed = smooth(widest.map((radius) => [radius, 0, 0]), window);
  return frames.map((frame) => [middles[frame], smoothed[frame][0]]);
}

/** The bodies that are followed: all that move; of those at rest the ones that touch, if any do. */
const followed = [...picture.radii.keys()].filter((body) => picture.frames > 1 || !picture.contacts.length || inContact[body]);

/** The middle of the box around the bodies that belong together. */
function middleOf(frame) {
  const last = followed.length - 1, cut = followed.length >= 20 ? Math.floor(followed.length / 20) : 0;
  return [0, 1, 2].map((axis) => {
    const values = Float64Array.from(followed, (body) => coordinate(body, axis, frame)).sort();
    return (values[cut] + values[last - cut]) / 2;
  });
}

/** The radius that holds every body, or nine in ten if the others have gone far away. */
function radiusAround(middle, frame) {
  const reach = (body) => Math.hypot(...minus(centre(body, frame), middle)) + picture.radii[body];
  const reaches = Float64Array.from(followed, reach).sort(), last = followed.length - 1;
  return followed.length >= 20 ? Math.min(reaches[last], 2 * reaches[Math.floor(last * 0.9)]) : reaches[last];
}

/** The mean of every vector and its neighbours. */
function smooth(vectors, window) {
  return vectors.map((_, at) => {
    const near = vectors.slice(Math.max(0, at - window), at + window + 1);
    return times(near.reduce(add), 1 / near.length);
  });
}

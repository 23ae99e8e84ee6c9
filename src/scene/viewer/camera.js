// The camera: it orbits a target, which it follows until the user drags it or selects a contact.
const ANGLE = 0.6;
const still = matchMedia("(prefers-reduced-motion: reduce)").matches;

class Camera {
  constructor() {
    this.reset();
  }

  reset() {
    this.turn = -0.9;
    this.tilt = picture.walls && !picture.floor ? 0.62 : 0.34;
    this.zoom = 1;
    this.aim = null;
    this.share = 0;
    this.touched = false;
  }

  /** Goes to a place and stays there: [centre, radius]. */
  goTo(place) {
    if (this.aim && this.shown) this.from = this.shown;
    this.aim = place;
    this.zoom = 1;
    this.share = still ? 1 : 0;
    this.begun = performance.now();
  }

  /** Whether it is still on its way. */
  moving(now) {
    if (!this.aim || this.share === 1) return false;
    this.share = Math.min(1, (now - this.begun) / 500);
    return true;
  }

  drag(across, down) {
    this.turn -= across / 150;
    // Below a floor there is nothing to see.
    this.tilt = Math.min(1.5, Math.max(picture.floor === null ? -1.5 : 0.03, this.tilt + down / 150));
    this.touched = true;
  }

  nearer(factor) {
    this.zoom = Math.min(20, Math.max(0.2, this.zoom * factor));
    this.touched = true;
  }

  /** Matrices and the eye, for bodies within a ball [centre, radius]. */
  see(ball, aspect) {
    let [target, radius] = ball;
    if (this.aim) {
      const ease = this.share * this.share * (3 - 2 * this.share), from = this.from || ball;
      target = mix(from[0], this.aim[0], ease);
      radius = from[1] + (this.aim[1] - from[1]) * ease;
    } else {
      this.from = null;
    }
    this.shown = [target, radius];
    const narrowest = aspect < 1 ? 2 * Math.atan(Math.tan(ANGLE / 2) * aspect) : ANGLE;
    const away = radius / Math.sin(narrowest / 2) / this.zoom;
    const [ct, st, ci, si] = [Math.cos(this.turn), Math.sin(this.turn), Math.cos(this.tilt), Math.sin(this.tilt)];
    const eye = add(target, times([ci * ct, ci * st, si], away));
    const far = away * 4 + picture.span * 4;
    return {
      eye, target, radius, away,
      view: lookAt(eye, target),
      projection: perspective(ANGLE, aspect, Math.max(away / 200, far / 20000), far),
    };
  }
}

// The view: what is drawn, when, and how the user controls it.
class View {
  constructor(canvas, gl) {
    Object.assign(this, { canvas, gl });
    this.camera = new Camera();
    this.follow = ballsToFollow();
    this.spheres = new Spheres(gl);
    this.room = new Room(gl);
    this.reset = document.getElementById("reset");
    const changed = () => this.wake();
    this.playback = new Playback(changed);
    this.contacts = new Contacts(this.playback, this.camera, changed);
    this.energy = new EnergyCurve(this.playback);
    this.listen();
    new ResizeObserver(changed).observe(canvas);
    for (const query of ["(prefers-color-scheme: dark)", "(resolution: 1dppx)"]) matchMedia(query).addEventListener("change", changed);
    this.wake();
  }

  /** Draws now, and again in the next frame if something moves. */
  wake() {
    if (!this.energy) return;
    this.draw();
    if (this.asked) return;
    this.asked = requestAnimationFrame((now) => {
      this.asked = 0;
      this.playback.tick(now);
      const going = this.camera.moving(now);
      if (this.playback.running || going) this.wake(); else this.draw();
    });
  }

  get theme() {
    const dark = matchMedia("(prefers-color-scheme: dark)").matches;
    return dark
      ? { back: [0.085, 0.095, 0.115], ground: [0.15, 0.165, 0.19], line: [0.27, 0.3, 0.34] }
      : { back: [0.955, 0.965, 0.975], ground: [0.89, 0.9, 0.915], line: [0.74, 0.76, 0.79] };
  }

  draw() {
    const { canvas, gl } = this, scale = Math.min(2, window.devicePixelRatio || 1);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((size) => Math.max(1, Math.round(size * scale)));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const time = this.playback.shown, theme = this.theme, light = unit([0.35, -0.5, 0.9]);
    const ball = this.follow[Math.round(time)];
    const camera = this.camera.see(ball, width / height);
    const { solid, faint, balls } = bodiesAt(time, this.playback.framesPerSecond, this.contacts.contact);
    gl.viewport(0, 0, width, height);
    gl.clearColor(...theme.back, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE);
    this.room.draw(camera, light, balls, theme);
    // Solid spheres cover samples of a pixel instead of being blended with it: their edges hide what is behind them.
    gl.disable(gl.BLEND);
    gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
    this.spheres.draw(solid, camera, light, Boolean(turns));
    gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    this.spheres.draw(faint, camera, light, false);
    gl.depthMask(true);
    const marks = this.contacts.marks();
    if (marks && marks.length) {
      gl.clear(gl.DEPTH_BUFFER_BIT);
      this.spheres.draw(marks, camera, light, false);
    }
    this.energy.show();
    this.reset.hidden = !(this.camera.touched || this.camera.aim);
    canvas.dataset.frame = String(Math.round(time));
  }

  listen() {
    const { canvas, camera } = this, pointers = new Map();
    const apart = () => { const [a, b] = [...pointers.values()]; return Math.hypot(a[0] - b[0], a[1] - b[1]); };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, [event.clientX, event.clientY]);
    });
    canvas.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
      const gap = pointers.size === 2 ? apart() : 0;
      pointers.set(event.pointerId, [event.clientX, event.clientY]);
      if (gap > 0) camera.nearer(apart() / gap);
      else if (pointers.size === 1) camera.drag(event.clientX - before[0], event.clientY - before[1]);
      this.wake();
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
    canvas.addEventListener("wheel", (event) => {
      // A page that is scrolled past the picture goes on scrolling.
      if (document.activeElement !== canvas && !event.ctrlKey) return;
      event.preventDefault();
      camera.nearer(Math.exp(-event.deltaY / 800));
      this.wake();
    }, { passive: false });
    this.reset.addEventListener("click", () => { camera.reset(); this.contacts.choose(-1); });
  }
}

const canvas = document.getElementById("scene");
const gl = canvas.getContext("webgl2", { antialias: true, alpha: false });
if (gl) {
  new View(canvas, gl);
} else {
  document.getElementById("missing").hidden = false;
  canvas.hidden = true;
}

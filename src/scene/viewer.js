"use strict";
// Spheres on a canvas: turned by dragging, drawn from the farthest to the nearest, played frame by frame.
(() => {
  const canvas = document.getElementById("scene");
  const words = (name) => (canvas.dataset[name] || "").split(" ").filter((w) => w !== "").map(Number);
  const radii = words("radii"), middle = words("middle"), steps = words("steps");
  const bytes = Uint8Array.from(atob(canvas.dataset.places), (c) => c.charCodeAt(0));
  const places = new Uint16Array(bytes.buffer);
  const count = radii.length;
  const play = document.getElementById("play"), at = document.getElementById("at"), step = document.getElementById("step");
  let frame = 0, running = Boolean(play), turn = 0.6, tilt = 0.35, zoom = 1, last = 0;

  function draw() {
    const scale = window.devicePixelRatio || 1;
    const width = canvas.clientWidth * scale, height = canvas.clientHeight * scale;
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    const pen = canvas.getContext("2d");
    pen.clearRect(0, 0, width, height);
    const size = Math.min(width, height) * 0.72 * zoom;
    const [ct, st, ci, si] = [Math.cos(turn), Math.sin(turn), Math.cos(tilt), Math.sin(tilt)];
    const balls = [];
    for (let i = 0; i < count; i++) {
      const o = (frame * count + i) * 3;
      const [x, y, z] = [0, 1, 2].map((a) => places[o + a] / 65535 - middle[a]);
      const u = x * ct - y * st, v = x * st + y * ct;
      balls.push({ i, u, w: z * ci - v * si, far: v * ci + z * si });
    }
    balls.sort((a, b) => b.far - a.far);
    const dark = matchMedia("(prefers-color-scheme: dark)").matches;
    for (const ball of balls) {
      const r = Math.max(radii[ball.i] * size, 1), cx = width / 2 + ball.u * size, cy = height / 2 - ball.w * size;
      const hue = (ball.i * 137.5) % 360, near = Math.max(0, Math.min(1, 0.5 - ball.far));
      pen.beginPath();
      pen.arc(cx, cy, r, 0, 2 * Math.PI);
      pen.fillStyle = `hsl(${hue} 45% ${dark ? 30 + 25 * near : 45 + 25 * near}%)`;
      pen.fill();
      pen.strokeStyle = dark ? "#15181d" : "#ffffff";
      pen.lineWidth = scale;
      pen.stroke();
    }
    if (step) { step.value = `step ${steps[frame]}`; at.value = String(frame); }
    canvas.dataset.frame = String(frame);
  }

  function tick(now) {
    if (running && now - last > 33) {
      last = now;
      frame = (frame + 1) % steps.length;
      draw();
    }
    requestAnimationFrame(tick);
  }

  if (play) {
    play.addEventListener("click", () => { running = !running; play.textContent = running ? "Pause" : "Play"; });
    at.addEventListener("input", () => { running = false; play.textContent = "Play"; frame = Number(at.value); draw(); });
  }
  canvas.addEventListener("pointermove", (e) => {
    if (e.buttons & 1) { turn += e.movementX / 150; tilt += e.movementY / 150; draw(); }
  });
  canvas.addEventListener("wheel", (e) => { e.preventDefault(); zoom *= Math.exp(-e.deltaY / 800); draw(); }, { passive: false });
  window.addEventListener("resize", draw);
  draw();
  if (play) requestAnimationFrame(tick);
})();

// The cantilever of the joints' case in the engines that npm brings: the same boxes, steps and units. Prints JSON.
const length = 20, height = 1, density = 7800, g = 10, E = 210e9, fy = 350e6; // m, m, kg/m³, m/s², Pa, Pa; 1 m deep
const exact = (density * height * g * length ** 2) / 2; // N m, the root's moment

// Each is built of n boxes and tells of itself: step(dt, iterations), moment() of the root, tip(), gap().
async function planck() {
  const pl = await import('planck');
  return n => {
    const l = length / n, world = new pl.World({ gravity: { x: 0, y: -g }, allowSleep: false });
    const ground = world.createBody(), pieces = [], joints = [];
    for (let i = 0; i < n; ++i) {
      const body = world.createBody({ type: 'dynamic', position: { x: (i + 0.5) * l, y: 0 } });
      body.createFixture({ shape: new pl.Box(l / 2, height / 2), density, filterGroupIndex: -1 });
      joints.push(world.createJoint(new pl.WeldJoint({}, i ? pieces[i - 1] : ground, body, { x: i * l, y: 0 })));
      pieces.push(body);
    }
    let last = 1 / 60;
    return {
      step(dt, iterations) { world.step((last = dt), iterations, Math.ceil((3 * iterations) / 8)); },
      moment: () => Math.abs(joints[0].getReactionTorque(1 / last)),
      tip: () => pieces[n - 1].getPosition().y,
      gap: () => Math.max(...joints.map(j => {
        const a = j.getAnchorA(), b = j.getAnchorB();
        return Math.hypot(a.x - b.x, a.y - b.y);
      })),
    };
  };
}

// Box2D v3 in either form: what differs is where a joint's frames are.
function version3(b2, place) {
  return n => {
    const l = length / n, def = b2.b2DefaultWorldDef(), vec = (x, y) => place.vec(b2, x, y);
    def.gravity = vec(0, -g);
    def.enableSleep = false;
    const world = b2.b2CreateWorld(def);
    const body = (x, dynamic) => {
      const d = b2.b2DefaultBodyDef();
      if (dynamic) d.type = place.dynamic(b2);
      d.position = vec(x, 0);
      return b2.b2CreateBody(world, d);
    };
    const ground = body(0, false), pieces = [], joints = [];
    for (let i = 0; i < n; ++i) {
      const piece = body((i + 0.5) * l, true), shape = b2.b2DefaultShapeDef();
      shape.density = density;
      place.apart(shape);
      b2.b2CreatePolygonShape(piece, shape, b2.b2MakeBox(l / 2, height / 2));
      const d = b2.b2DefaultWeldJointDef();
      place.join(d, i ? pieces[i - 1] : ground, piece, vec(i ? l / 2 : 0, 0), vec(-l / 2, 0));
      joints.push(b2.b2CreateWeldJoint(world, d));
      pieces.push(piece);
    }
    const at = (b, x) => b2.b2Body_GetWorldPoint(b, vec(x, 0));
    return {
      step: (dt, iterations) => b2.b2World_Step(world, dt, iterations),
      moment: () => Math.abs(b2.b2Joint_GetConstraintTorque(joints[0])),
      tip: () => b2.b2Body_GetPosition(pieces[n - 1]).y,
      gap: () => Math.max(...pieces.map((b, i) => {
        const p = at(b, -l / 2), q = i ? at(pieces[i - 1], l / 2) : vec(0, 0);
        return Math.hypot(p.x - q.x, p.y - q.y);
      })),
      end: () => b2.b2DestroyWorld(world),
    };
  };
}
async function wasm() {
  const b2 = await (await import('box2d3-wasm')).default();
  return version3(b2, {
    vec: (b, x, y) => new b.b2Vec2(x, y),
    dynamic: b => b.b2BodyType.b2_dynamicBody,
    apart: shape => { const f = shape.filter; f.groupIndex = -1; shape.filter = f; },
    join(d, a, b, p, q) {
      const base = d.base, A = base.localFrameA, B = base.localFrameB;
      base.bodyIdA = a; base.bodyIdB = b;
      A.p = p; B.p = q;
      base.localFrameA = A; base.localFrameB = B;
      d.base = base;
    },
  });
}
async function phaser() {
  const b2 = await import('phaser-box2d/dist/PhaserBox2D.js');
  b2.CreateWorldArray?.() ?? b2.b2CreateWorldArray?.();
  return version3(b2, {
    vec: (b, x, y) => new b.b2Vec2(x, y),
    dynamic: b => b.b2BodyType.b2_dynamicBody,
    apart: shape => { shape.filter.groupIndex = -1; },
    join(d, a, b, p, q) { d.bodyIdA = a; d.bodyIdB = b; d.localAnchorA = p; d.localAnchorB = q; },
  });
}

// A chain of hinges with the springs of a beam, as MuJoCo is made for: it has no gaps.
async function mujoco() {
  const mj = await (await import('@mujoco/mujoco')).default();
  return n => {
    const l = length / n, k = (E * height ** 3) / 12 / l, m = density * height * l;
    const inertia = (m * (l ** 2 + height ** 2)) / 12;
    let body = '';
    for (let i = n - 1; i >= 0; --i) {
      const spring = i ? k : 2 * k;
      body = `<body pos="${i ? l : 0} 0 0"><joint type="hinge" axis="0 0 1" stiffness="${spring}" damping="${0.1 * spring}"/>
        <inertial pos="${l / 2} 0 0" mass="${m}" diaginertia="${inertia} ${inertia} ${inertia}"/>${body}</body>`;
    }
    const xml = dt => `<mujoco><option gravity="0 ${-g} 0" timestep="${dt}" integrator="implicitfast"/>
      <worldbody>${body}</worldbody></mujoco>`;
    let model, data;
    return {
      step(dt) {
        if (!model) { model = mj.MjModel.from_xml_string(xml(dt)); data = new mj.MjData(model); }
        mj.mj_step(model, data);
      },
      moment: () => Math.abs(2 * k * (data.qpos[0] + 0.1 * data.qvel[0])),
      tip() {
        let y = 0, angle = 0;
        for (let i = 0; i < n; ++i) { angle += data.qpos[i]; y += (i < n - 1 ? l : l / 2) * Math.sin(angle); }
        return y;
      },
      gap: () => 0,
      end() { data.delete(); model.delete(); },
    };
  };
}

const quick = process.argv.includes('--quick'), seconds = quick ? 10 : 60, batch = 5;
const engines = [['planck 1.5.0', planck, 'iterations'], ['phaser-box2d 1.1.0', phaser, 'sub-steps'],
                 ['box2d3-wasm 5.2.0', wasm, 'sub-steps'], ['MuJoCo 3.14.0 (wasm)', mujoco, '']];
const runs = [];
for (const n of quick ? [10] : [5, 10, 20, 40])
  for (const [hz, iterations] of [[60, 10], [60, 40], [120, 10], [240, 10]]) runs.push({ n, hz, iterations });
const rows = [], absent = [];
for (const [name, load, unit] of engines) {
  let build;
  try { build = await load(); } catch (error) { absent.push(`${name}: ${error.message}`); continue; }
  for (const { n, hz, iterations } of runs) {
    if (!unit && iterations !== 10) continue;
    const scene = build(n), steps = seconds * hz, dt = 1 / hz;
    let sum = 0, count = 0, gap = 0, spent = 0;
    for (let i = 0; i < steps; i += batch) {
      const start = process.cpuUsage();
      for (let k = 0; k < batch; ++k) scene.step(dt, iterations);
      spent += process.cpuUsage(start).user;
      gap = Math.max(gap, scene.gap());
      if (i >= steps - 5 * hz) { sum += scene.moment(); ++count; }
    }
    rows.push({ engine: name, per: unit, n, hz, iterations, moment: sum / count / exact - 1, tip: scene.tip(), gap,
                us: spent / steps / n });
    scene.end?.();
  }
}
console.log(JSON.stringify({ rows, absent }));

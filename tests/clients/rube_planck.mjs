// A player of R.U.B.E. scenes as one writes it who knows nothing of ductile, for planck.js: bodies, fixtures, welds,
// revolute, prismatic and wheel joints; customProperties are not looked at.
import * as planck from 'planck';

const float = new DataView(new ArrayBuffer(4));
const number = (value = 0) => {
  if (typeof value !== 'string') return value;
  float.setUint32(0, parseInt(value, 16));
  return float.getFloat32(0);
};
const vec = (value) => planck.Vec2(number(value?.x), number(value?.y));
const points = ({x, y}) => x.map((value, i) => planck.Vec2(number(value), number(y[i])));

function shape(fixture) {
  if (fixture.circle) return new planck.Circle(vec(fixture.circle.center), number(fixture.circle.radius));
  if (fixture.polygon) return new planck.Polygon(points(fixture.polygon.vertices));
  if (fixture.chain) return new planck.Chain(points(fixture.chain.vertices));
  return new planck.Edge(vec(fixture.edge.vertex1), vec(fixture.edge.vertex2));
}

export function load(scene) {
  const world = new planck.World({gravity: vec(scene.gravity), allowSleep: scene.allowSleep ?? false});
  const bodies = (scene.body ?? []).map((b) => {
    const body = world.createBody({
      type: ['static', 'kinematic', 'dynamic'][b.type ?? 0], position: vec(b.position), angle: number(b.angle),
      linearVelocity: vec(b.linearVelocity), angularVelocity: number(b.angularVelocity),
      allowSleep: b.allowSleep ?? true, awake: b.awake ?? false});
    for (const f of b.fixture ?? []) {
      body.createFixture({
        shape: shape(f), density: number(f.density), friction: number(f.friction), restitution: number(f.restitution),
        filterGroupIndex: f['filter-groupIndex'] ?? 0});
    }
    if (b.type === 2) {
      body.setMassData({mass: number(b['massData-mass']), center: vec(b['massData-center']), I: number(b['massData-I'])});
    }
    return body;
  });
  const make = {
    weld: (j, common) => new planck.WeldJoint(
      {...common, referenceAngle: number(j.refAngle), frequencyHz: number(j.frequency), dampingRatio: number(j.dampingRatio)}),
    revolute: (j, common) => new planck.RevoluteJoint(
      {...common, referenceAngle: number(j.refAngle), enableMotor: j.enableMotor ?? false, enableLimit: j.enableLimit ?? false,
       lowerAngle: number(j.lowerLimit), upperAngle: number(j.upperLimit), motorSpeed: number(j.motorSpeed),
       maxMotorTorque: number(j.maxMotorTorque)}),
    prismatic: (j, common) => new planck.PrismaticJoint(
      {...common, referenceAngle: number(j.refAngle), localAxisA: vec(j.localAxisA)}),
    wheel: (j, common) => new planck.WheelJoint(
      {...common, localAxisA: vec(j.localAxisA), frequencyHz: number(j.springFrequency),
       dampingRatio: number(j.springDampingRatio)}),
  };
  for (const j of scene.joint ?? []) {
    const common = {bodyA: bodies[j.bodyA ?? 0], bodyB: bodies[j.bodyB ?? 0], localAnchorA: vec(j.anchorA),
                    localAnchorB: vec(j.anchorB), collideConnected: j.collideConnected ?? false};
    world.createJoint(make[j.type](j, common));
  }
  const body = (name) => bodies[scene.body.findIndex((b) => b.name === name)];
  return {
    gravity: ([x, y]) => world.setGravity(planck.Vec2(x, y)),
    step: () => world.step(1 / 60, 8, 3),
    angle: (name) => body(name).getAngle(),
    position: (name) => [body(name).getPosition().x, body(name).getPosition().y],
    mass: (name) => body(name).getMass(),
  };
}

// Box2D 2.4 ported to TypeScript (@box2d/core): what `--to box2d` says under "2.4".
import core from '@box2d/core';
import {setFields} from './fields.mjs';

const B = core;
const types = {static: B.b2BodyType.b2_staticBody, kinematic: B.b2BodyType.b2_kinematicBody,
               dynamic: B.b2BodyType.b2_dynamicBody};
const defs = {weld: B.b2WeldJointDef, revolute: B.b2RevoluteJointDef, prismatic: B.b2PrismaticJointDef,
              wheel: B.b2WheelJointDef, motor: B.b2MotorJointDef};
const vec = ([x, y]) => new B.b2Vec2(x, y);

export function load(doc, choose) {
  const world = B.b2World.Create(vec(doc.gravity));
  const bodies = {};
  for (const b of doc.bodies) {
    const body = bodies[b.name] = world.CreateBody({
      type: types[b.type], position: vec(b.position), linearVelocity: vec(b.linearVelocity),
      angularVelocity: b.angularVelocity, allowSleep: b.allowSleep});
    for (const f of b.fixtures) {
      let shape;
      if (f.polygon) {
        shape = new B.b2PolygonShape();
        if (!shape.Set(f.polygon.map(vec))) throw new Error(`${b.name} has a fixture that is too thin`);
      } else {
        shape = new B.b2CircleShape(f.circle);
        shape.m_p.Set(...f.center);
      }
      body.CreateFixture({shape, friction: f.friction, restitution: f.restitution, density: f.density,
                          filter: {groupIndex: f.groupIndex}});
    }
    if (b.type === 'dynamic') {
      const mass = new B.b2MassData();
      mass.mass = b.mass;
      mass.I = b.inertia;
      body.SetMassData(mass);
    }
  }
  for (const joint of doc.joints) {
    const {type, ...fields} = choose(joint)['2.4'];
    const def = new defs[type]();
    def.bodyA = bodies[joint.bodyA];
    def.bodyB = bodies[joint.bodyB];
    setFields(def, type, fields, (value) => Array.isArray(value) ? vec(value) : value);
    world.CreateJoint(def);
  }
  return {
    gravity: (g) => world.SetGravity(vec(g)),
    step: () => world.Step(1 / 60, {velocityIterations: 8, positionIterations: 3}),
    angle: (name) => bodies[name].GetAngle(),
    position: (name) => [bodies[name].GetPosition().x, bodies[name].GetPosition().y],
    mass: (name) => bodies[name].GetMass(),
  };
}

//! The tree of nodes, and the lights and the camera in it.

use std::f64::consts::{FRAC_PI_2, PI};

use ::gltf::khr_lights_punctual::Kind as LightKind;
use ::gltf::{Document, Node};

use super::LeftOut;
use super::material::encoded;
use crate::model_file::rig::place::Placement;
use crate::model_file::rig::{self, Eye, Kind, Skeleton, Source};

/// The nodes of a file, and those of its scene in the order of the file.
pub(super) fn read(document: &Document) -> Result<(Skeleton, Vec<Node<'_>>), String> {
    let all: Vec<Node<'_>> = document.nodes().collect();
    let mut is_child = vec![false; all.len()];
    all.iter().flat_map(Node::children).for_each(|child| is_child[child.index()] = true);
    let without_parent = || (0..all.len()).filter(|&node| !is_child[node]).collect::<Vec<_>>();
    let roots = match document.default_scene().or_else(|| document.scenes().next()) {
        Some(scene) => scene.nodes().map(|node| node.index()).collect(),
        None => without_parent(),
    };
    let mut tree = Tree { parents: vec![None; all.len()], is_placed: vec![false; all.len()], order: Vec::new() };
    tree.place(&all, roots, true)?;
    let scene = tree.order.iter().map(|&node| all[node].clone()).collect();
    // Joints may be outside the scene.
    tree.place(&all, without_parent(), false)?;
    let parts = |node: &Node<'_>| {
        let (translation, rotation, scale) = node.transform().decomposed();
        (translation.map(f64::from), rotation.map(f64::from), scale.map(f64::from))
    };
    let node = |node: &Node<'_>| rig::Node {
        parent: tree.parents[node.index()],
        rest: Placement::of_matrix(node.transform().matrix()),
        parts: parts(node),
    };
    let nodes = all.iter().map(node).collect();
    Ok((Skeleton { order: tree.order, nodes, matrices: Vec::new() }, scene))
}

struct Tree {
    parents: Vec<Option<usize>>,
    is_placed: Vec<bool>,
    /// Parents before children.
    order: Vec<usize>,
}

impl Tree {
    /// Places nodes and all below them. With `once`, a node that is already placed is an error; otherwise it is
    /// skipped.
    fn place(&mut self, all: &[Node<'_>], roots: Vec<usize>, once: bool) -> Result<(), String> {
        let mut waiting: Vec<(usize, Option<usize>)> = roots.into_iter().rev().map(|root| (root, None)).collect();
        while let Some((node, parent)) = waiting.pop() {
            if core::mem::replace(&mut self.is_placed[node], true) {
                if once {
                    return Err(format!("nodes[{node}] is in the scene twice"));
                }
                continue;
            }
            self.parents[node] = parent;
            self.order.push(node);
            let children: Vec<usize> = all[node].children().map(|child| child.index()).collect();
            waiting.extend(children.into_iter().rev().map(|child| (child, Some(node))));
        }
        Ok(())
    }
}

/// The lights in a scene.
pub(super) fn lights(scene: &[Node<'_>], left_out: &mut LeftOut) -> Vec<Source> {
    let mut lights = Vec::new();
    for node in scene {
        let Some(light) = node.light() else { continue };
        let source = Source {
            node: node.index(),
            kind: match light.kind() {
                LightKind::Directional => Kind::Sun,
                LightKind::Point => Kind::Lamp { range: range(light.range()), cone: None },
                LightKind::Spot { inner_cone_angle, outer_cone_angle } => {
                    let outer = f64::from(outer_cone_angle).min(FRAC_PI_2);
                    let cone = Some([f64::from(inner_cone_angle).clamp(0.0, outer.max(0.0)), outer]);
                    Kind::Lamp { range: range(light.range()), cone }
                }
            },
            color: light.color().map(|channel| encoded(channel.into()) as f32),
            intensity: light.intensity().into(),
        };
        let has_angle =
            !matches!(source.kind, Kind::Lamp { cone: Some([inner, outer]), .. } if !(outer > 0.0 && inner >= 0.0));
        let shines = source.intensity > 0.0 && source.intensity.is_finite() && source.color.iter().any(|c| *c > 0.0);
        if has_angle && shines {
            lights.push(source);
        } else {
            left_out.insert("lights that emit no light");
        }
    }
    lights
}

fn range(range: Option<f32>) -> Option<f64> {
    range.map(f64::from).filter(|range| *range > 0.0 && range.is_finite())
}

/// The first perspective camera of a scene.
pub(super) fn camera(document: &Document, scene: &[Node<'_>], left_out: &mut LeftOut) -> Option<Eye> {
    for node in scene {
        let Some(camera) = node.camera() else { continue };
        // If the file states one kind of camera and has the numbers of the other, `gltf` looks for the wrong ones.
        let perspective = document.as_json().cameras.get(camera.index()).and_then(|camera| camera.perspective.as_ref());
        let Some(perspective) = perspective else {
            left_out.insert("orthographic cameras");
            continue;
        };
        let (field_of_view, near) = (f64::from(perspective.yfov), f64::from(perspective.znear));
        if field_of_view > 0.0 && field_of_view < PI {
            return Some(Eye {
                node: node.index(),
                field_of_view,
                near: if near > 0.0 { near } else { f64::MIN_POSITIVE },
            });
        }
        left_out.insert("cameras without a valid field of view");
    }
    None
}

// What of the page is chosen: one scene for all of it, and each chart's menus. It stands in the
// address behind #, so that a view can be linked to:
// #at=convergence&scene=free_string&work-precision.cost_field=rate
const view = new Map(new URLSearchParams(location.hash.slice(1)));
const on_scene = []; // what follows the scene: called with its name

function choose(key, value) {
  if (value === null) view.delete(key);
  else view.set(key, value);
  history.replaceState(null, "", "#" + new URLSearchParams([...view]));
}

const scene_shown = () => document.getElementById("scene")?.value ?? report.scenes[0] ?? "";

function scene_menu(scenes) {
  const select = element("select", {id: "scene"}, ...scenes.map(name => new Option(name)));
  select.selectedIndex = Math.max(0, scenes.indexOf(view.get("scene")));
  select.onchange = async () => {
    choose("scene", select.selectedIndex === 0 ? null : select.value);
    document.documentElement.dataset.ready = "false";
    for (const follow of on_scene) await follow(select.value);
    document.documentElement.dataset.ready = "true";
  };
  return element("label", {}, "scene ", select);
}

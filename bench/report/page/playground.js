// Frame for `report --playground`: holds the page built by ./play, with the scene of the report,
// and is filled when opened.
document.getElementById("playground").ontoggle = event => {
  if (!event.target.open || document.querySelector("#playground iframe")) return;
  const name = scene_shown() || page.manifest?.scene?.name || "",
    text = page.manifest?.scenes?.[name] ?? page.manifest?.scene?.text;
  const address = new URLSearchParams({scene: name, ...(text ? {text} : {})}),
    frame = document.createElement("iframe"),
    begins = "<script>\nconst library =";
  const play = new TextDecoder().decode(
    Uint8Array.from(atob(document.getElementById("play").textContent), c => c.charCodeAt(0)),
  );
  frame.title = "the string of " + name;
  frame.style.cssText = "width: 100%; height: 90vh; border: 0";
  frame.srcdoc = play.replace(
    begins,
    () => `<script>\nwindow.jvari_address = "#${address}";\nconst library =`,
  );
  event.target.append(frame);
};

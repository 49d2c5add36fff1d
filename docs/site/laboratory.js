// Frames of the laboratory get their page. Opened from files a page may not fetch its parts: there it is the one in one file.
document.addEventListener("DOMContentLoaded", () => {
  const there = (page) => (location.protocol === "file:" ? page.replace("/index.html#", "/lagroid.html#") : page);
  for (const link of document.querySelectorAll("a.laboratory")) link.href = there(link.getAttribute("href"));
  for (const frame of document.querySelectorAll("iframe.laboratory")) {
    frame.loading = "lazy";
    frame.src = there(frame.dataset.page);
  }
});
